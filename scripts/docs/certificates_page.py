"""What is proved, in words, with the numbers of the tables."""

from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal

import numpy as np
import pandas as pd

from claims.about_proofs import stable_motions


def digits(low: float, high: float) -> str:
    """An interval around two bounds in decimals, with a digit more than their width needs."""
    width = Decimal(high) - Decimal(low)
    places = max(0, 1 - width.adjusted()) if width else 15
    unit = Decimal(1).scaleb(-places)
    below, above = (
        Decimal(value).quantize(unit, rounding=way) for value, way in ((low, ROUND_FLOOR), (high, ROUND_CEILING))
    )
    return f"[{below}, {above}]"


def counts(orbits: pd.DataFrame) -> str:
    """How many orbits of each period are proved, as a table."""
    lines = ["| Period in cycles | Orbits | Proved | Stable | Unstable |", "|---|---|---|---|---|"]
    for period, rows in orbits.groupby("period"):
        stable, unstable = ((rows.stability == kind).sum() for kind in ("stable", "unstable"))
        lines.append(f"| {period} | {len(rows)} | {rows.contained.sum()} | {stable} | {unstable} |")
    return "\n".join(lines)


def refused(orbits: pd.DataFrame) -> str:
    """The orbits that are not proved, with the reasons."""
    rows = orbits[~orbits.contained]
    if rows.empty:
        return "None was refused."
    lines = [
        f"- branch {row.branch}, {row.acceleration:g} m/s², {row.period} cycles: {row.reason}"
        for row in rows.itertuples()
    ]
    return "Refused, with the reason:\n\n" + "\n".join(lines)


def both_stable(orbits: pd.DataFrame) -> list[float]:
    """Amplitudes (m/s²) at which at least two stable motions are proved."""
    counts = stable_motions(orbits)
    return [float(acceleration) for acceleration in counts.index[counts >= 2]]


def listed(values) -> str:
    return ", ".join(f"{value:g}" for value in values) or "none"


def bifurcations(table: pd.DataFrame) -> str:
    """Brackets of folds and doublings, as a table."""
    lines = [
        "| Bifurcation | Period of the orbit in cycles | Amplitude in m/s², within | In floating point |",
        "|---|---|---|---|",
    ]
    for row in table.itertuples():
        kind = "fold" if row.kind == "fold" else "period doubling"
        amplitude = digits(row.acceleration_low, row.acceleration_high) if row.proved else f"refused: {row.reason}"
        lines.append(f"| {kind} {row.number} | {row.period} | {amplitude} | {row.stored_acceleration:.10f} |")
    return "\n".join(lines)


def ratios(table: pd.DataFrame) -> str:
    """Bounds of Feigenbaum's ratios of the proved doublings, which follow from those of the amplitudes."""
    rows = table[(table.kind == "period_doubling") & table.proved]
    low, high = rows.acceleration_low.to_numpy(), rows.acceleration_high.to_numpy()
    lines = []
    for k in range(1, len(rows) - 1):
        least = (low[k] - high[k - 1]) / (high[k + 1] - low[k])
        most = (high[k] - low[k - 1]) / (low[k + 1] - high[k])
        # One step outwards for each of the roundings above would be enough; these are many.
        lines.append(digits(least * (1.0 - 1e-12), most * (1.0 + 1e-12)))
    return ", ".join(lines) or "none"


def chaos(table: pd.DataFrame) -> str:
    """The amplitudes with proved chaos, as a table."""
    lines = ["| Amplitude in m/s² | Excursion in cycles | Entropy per cycle, at least |", "|---|---|---|"]
    for row in table.itertuples():
        entropy = f"{np.floor(row.entropy * 1e4) / 1e4:.4f}" if row.proved else f"not proved: {row.reason}"
        lines.append(f"| {row.acceleration:g} | {row.sets if row.proved else '–'} | {entropy} |")
    return "\n".join(lines)


def page(orbits: pd.DataFrame, folds: pd.DataFrame, horseshoes: pd.DataFrame) -> str:
    """The page in Markdown."""
    settings = orbits.attrs
    held = orbits[orbits.contained]
    jumping = held[(held.acceleration == 40.0) & (held.stability == "stable") & (held.impacts > 0)]
    example = ""
    if len(jumping):
        row = jumping.iloc[0]
        example = (
            f"The jumping orbit at 40 m/s², for one, meets the plate at a phase within "
            f"{digits(row.impact_phase_low, row.impact_phase_high)} rad, with a speed within "
            f"{digits(row.impact_speed_low, row.impact_speed_high)} m/s (the table's floats; the "
            f"computation itself holds its states to {row.half_width:.0e} of g/ω² and g/ω). "
        )
    chaotic = horseshoes[horseshoes.proved]
    return f"""# What is proved

Other pages of this project compute; this one lists theorems. Each says that something is so for the exact equations
of the model, with no error of rounding, of truncation, or of an iteration that was stopped. They are proved by the
rule `certificates` (`snakemake results/orbits/certificates.parquet`) with interval arithmetic: every number is a ball
that contains the exact one, and every formula is evaluated so that the result contains all exact results. The figure
is `figures/certificates.pdf`. All numbers on this page come from the tables of that rule. In `results/claims.md` the
statements on two states (C02), on regular motion (C03, C19) and on chaos (C15) quote them.

## The model that the theorems are about

- The vertical motion of Eqs. 3 to 9: gravity, a harmonic plate, Hertz contact with viscous damping while the part is
  in the plate. Friction and the horizontal motion do not act back on it.
- **Reading**: `tension: allow`. The contact pulls where damping outweighs stiffness, and ends where the penetration
  ends.
- **Numbers**: those of the config, each the decimal that is written, not the nearest float: 0.3 is 3/10, 0.7e-3 is
  7/10000, g = 9.81 is 981/100, and the angle of throw is 12° = π/15 exactly. So are the amplitudes. Where columns of
  a table end in `_low` and `_high` they are floats, rounded outwards.
- One solution: written for δ and Y = δ̇ + (d_c/m) max(δ, 0) the rates are Lipschitz, so that each start has exactly
  one motion. They are smooth but at δ = 0, which is crossed with a speed, by proof; an orbit that grazes is refused.

## Periodic orbits

For every orbit of the table with `contained`: there is **exactly one** periodic orbit in a box around the stored one,
its least period is the stated number of excitation cycles, and it has the stated number of impacts, with penetration
between impact and separation and a gap between separation and impact. `stable` means that both Floquet multipliers
lie inside the unit circle, so that it attracts all starts nearby; `unstable` that one lies outside. {example}The
stored orbits lie no farther than {orbits.distance.max():.0e} (in g/ω² and g/ω, median {orbits.distance.median():.0e})
from the proved ones.

{len(orbits)} orbits at {orbits.acceleration.nunique()} amplitudes from {orbits.acceleration.min():g} to
{orbits.acceleration.max():g} m/s² were tried, {len(held)} are proved. {refused(orbits)}

{counts(orbits)}

**Two stable motions coexist** at {listed(both_stable(orbits))} m/s²: orbits that are proved to be stable, and to differ
by their times in contact.

## Fold and doublings

Between the two amplitudes of a period doubling the orbit is proved to exist, to be the only one in its box, and to
depend smoothly on the amplitude, and (1 + μ1)(1 + μ2) is proved to have different signs at the ends: **a multiplier
passes -1 in between**. On an arc of the branch around the fold the same holds along the arc: the amplitude is proved
to be least within it, in the interval given, and (1 - μ1)(1 - μ2) to change its sign: **the branch turns there, and a
multiplier is +1**.

{bifurcations(folds)}

Ratios of the distances of successive doublings: {ratios(folds)}; Feigenbaum's constant is their limit if the cascade
is of the universal kind, which is not proved.

## Chaos

At {listed(chaotic.acceleration)} m/s² there are small parallelograms around an unstable orbit of one cycle and along
an excursion from it and back, each of which the stroboscopic map lays across the next one. Hence **every** sequence
of stays near the orbit (one cycle) and excursions is the history of some start, and infinitely many periodic orbits
exist: the map has positive topological entropy.

{chaos(horseshoes)}

## What is not proved

- That the motion from a given start is chaotic, or that chaos attracts: the starts with such histories may be a set
  of measure zero.
- That there are no other orbits: the boxes are small, and between the amplitudes of the table nothing is said.
- That a doubling is of the generic kind: neither that the multiplier passes -1 only once within the bracket, nor on
  which side an orbit of twice the period is born. That such orbits exist is proved where the table holds them.
- Basins of attraction, mean feeding velocities, Lyapunov exponents, anything with friction.
- Anything for `tension: frictionless` or `clip`, or for orbits that graze.

## How, and what the proofs rest on

Every bound stands in `scripts/conveyor/certificates` with its reason.

- **Contact**: with δ = w² and dt = w ds the equations are polynomial but for sine and cosine, which join as two more
  unknowns. A step is a Taylor polynomial of order {settings["order"]}, whose coefficients floating point suggests
  (`double_double.py`) and Picard's operator proves; a bound on the rest follows from the polynomial itself
  (`taylor.py`).
- **Events**: roots of w and of the gap, each with a proof that there is exactly one and none before (`roots.py`).
- **Flight**: closed form (`flight.py`).
- **Derivatives**: those of (δ, Y) with Y = δ̇ + (d_c/m) δ, which need no jump at events; their determinant is checked
  against the time in contact (`motion.py`, `orbit.py`).
- **Orbits**: Krawczyk's operator on the states at several phases of each cycle (`newton.py`, `shooting.py`).
- **Brackets and chaos**: Bolzano's theorem along a proved branch (`brackets.py`); covering relations of Zgliczyński
  and Gidea (`covering.py`).

They rest on python-flint's ball arithmetic at {settings["bits"]} bits (chaos: {settings["chaos"]["bits"]}), on
Python, and on the processor. Tests repeat enclosures with other numbers of bits and orders and by hand-made bounds in
rational arithmetic, and see that false orbits, wrong periods, a turned sign and a grazing box are refused.
"""


def make(certificates: pd.DataFrame, certified_bifurcations: pd.DataFrame, certified_chaos: pd.DataFrame) -> str:
    """The page from the tables of what was proved."""
    return page(certificates, certified_bifurcations, certified_chaos)
