"""Periodic orbits, bifurcations and chaos, proved where floating point suggests them."""

import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from multiprocessing import get_context
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pandas as pd
from pyarrow import Field

from conveyor.analysis.bifurcations import continuation, periodic_orbits
from conveyor.analysis.bifurcations.continuation import Bifurcation
from conveyor.analysis.bifurcations.periodic_orbits import Orbit, ReturnMap
from conveyor.certificates.balls import Refused, bounds, exactly, precision
from conveyor.certificates.brackets import bracket_doubling, bracket_fold
from conveyor.certificates.covering import prove_horseshoe
from conveyor.certificates.excursion import plan_sets
from conveyor.certificates.law import Accuracy, Law, System, law_of
from conveyor.certificates.orbit import ProvedOrbit, check_near, prove_orbit
from conveyor.certificates.shooting import Shooting
from conveyor.solver.progress import bar
from pipeline import fields, grid


def ends(name: str, unit: str, description: str) -> tuple[Field, Field]:
    """Two columns: the ends of an interval that holds a number by proof, rounded outwards."""
    return (
        fields.number(f"{name}_low", unit, f"{description}: no larger than it, by proof; null where nothing is proved"),
        fields.number(f"{name}_high", unit, f"{description}: no smaller than it, by proof"),
    )


ARITHMETIC = (
    fields.count("bits", "bits of the arithmetic"),
    fields.count("order", "order of the Taylor series"),
)


TABLES = {
    "certificates": (
        fields.count("branch", "number of the branch; those above the stored ones are longer orbits of the cascade"),
        fields.count("period", "excitation cycles; the least period, if the orbit is proved"),
        fields.number("acceleration", "m/s²", "amplitude of the excitation, the decimal that is written"),
        fields.flag("contained", "whether exactly one orbit is proved in a box around the stored one"),
        fields.text("reason", "why not; null where it is"),
        fields.text("stability", "proved: stable or unstable; else open"),
        fields.count("impacts", "impacts in a period, proved if the orbit is"),
        fields.number(
            "stored_delta",
            "m",
            "penetration at the phase ψ0 of the orbit in floating point, found from the stored ones",
        ),
        fields.number("stored_v", "m/s", "its speed of approach there"),
        *ends("delta", "m", "penetration at the phase ψ0"),
        *ends("v", "m/s", "speed of approach at the phase ψ0"),
        *ends("impact_phase", "rad", "phase of the first impact after it"),
        *ends("impact_speed", "m/s", "speed of approach at the first impact"),
        *ends("duration", "s", "the period"),
        *ends("contact_time", "s", "time with contact force in a period"),
        *ends("trace", "1", "sum of the Floquet multipliers"),
        *ends("determinant", "1", "their product, exp(-(d_c/m) contact_time)"),
        *ends("multiplier_1_real", "1", "multiplier of larger modulus, real part; null where it is open which that is"),
        *ends("multiplier_1_imag", "1", "imaginary part"),
        *ends("multiplier_2_real", "1", "the other one, real part"),
        *ends("multiplier_2_imag", "1", "imaginary part"),
        fields.number("half_width", "1", "largest half-width of an enclosure of a state, in g/ω² and g/ω"),
        fields.number("distance", "1", "of the stored orbit from the enclosed one, in g/ω² and g/ω"),
        *ARITHMETIC,
    ),
    "certified_bifurcations": (
        fields.text("kind", "fold or period_doubling"),
        fields.count("number", "number of its kind"),
        fields.count("period", "excitation cycles of the orbit that folds or doubles"),
        fields.flag("proved", "whether it is"),
        fields.text("reason", "why not; null where it is"),
        fields.number("stored_acceleration", "m/s²", "amplitude that was computed in floating point"),
        *ends("acceleration", "m/s²", "amplitude of the bifurcation"),
        *ends(
            "test_begin",
            "1",
            "(1 ∓ μ1)(1 ∓ μ2) of a fold (-) or doubling (+) at the lower amplitude or first end of the arc",
        ),
        *ends("test_end", "1", "the same at the higher amplitude or the other end"),
        *ARITHMETIC,
    ),
    "certified_chaos": (
        fields.number("acceleration", "m/s²", "amplitude of the excitation, the decimal that is written"),
        fields.flag("proved", "whether covering relations that make chaos are proved"),
        fields.text("reason", "why not; null where they are"),
        fields.count(
            "sets", "parallelograms; an excursion from the first one and back takes as many excitation cycles"
        ),
        fields.number("entropy", "1", "topological entropy per excitation cycle: no larger than it, by proof"),
        fields.number("delta", "m", "penetration at the phase ψ0 of the orbit of one cycle in the first parallelogram"),
        fields.number("v", "m/s", "its speed of approach there"),
        *ARITHMETIC,
    ),
    "certificate_times": (
        fields.text("kind", "table of what was proved"),
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.count("period", "excitation cycles"),
        fields.count("impacts", "impacts in a period"),
        fields.number("seconds", "s", "of a processor; it differs from run to run"),
    ),
}


class Line(NamedTuple):
    """A branch in floating point: points (δ in m, v in m/s, â in m/s²) in their order, shape (n, 3)."""

    period: int
    points: np.ndarray


class Known(NamedTuple):
    """An orbit in floating point."""

    branch: int
    orbit: Orbit
    strobes: np.ndarray  # (δ, Y) at the beginnings of its cycles in units of the law, shape (period, 2)


class Work(NamedTuple):
    """One thing to prove: the function that does, and what it needs besides the settings."""

    prove: Callable[[dict, tuple], dict]
    about: tuple


def law(settings: dict) -> Law:
    """The conveyor with its numbers read as decimals."""
    return law_of(grid.conveyor_and_start(settings["model"])[0])


def shooting(settings: dict, period: int) -> Shooting:
    """The equations of the orbits of a period, with the accuracy of the settings."""
    return Shooting(law(settings), Accuracy(settings["order"], settings["tolerance"]), period)


def known(branch: int, returns: ReturnMap, unknown: np.ndarray) -> Known:
    """The orbit of a fixed point of a return map."""
    later = returns.strobes(unknown)[:-1, :2]
    return Known(branch, returns.describe(unknown), np.vstack([unknown[:2], later]))


def crossings(parameters: np.ndarray, branch: int, line: Line, acceleration: float) -> list[Known]:
    """The orbits of a branch at an amplitude, none twice: a branch may come by an orbit in several of its cycles.

    Where floating point finds none from the neighbours on the branch, their mean is taken: the proof says why it fails.
    """
    returns, found = ReturnMap(parameters, line.period), []
    above = line.points[:, 2] > acceleration
    for i in np.flatnonzero(above[1:] != above[:-1]):
        begin, end = line.points[i : i + 2]
        point = begin + (acceleration - begin[2]) / (end[2] - begin[2]) * (end - begin)
        guess = returns.scaled(acceleration, point[:2])
        unknown = returns.newton(guess)
        unknown = guess if unknown is None else unknown
        distances = [np.abs(other.strobes - unknown[:2]).max(axis=1).min() for other in found]
        if min(distances, default=np.inf) > continuation.SAME:
            found.append(known(branch, returns, unknown))
    return found


def stored_lines(table: pd.DataFrame, longest_period: int) -> dict[int, Line]:
    """The branches of the table `branches` up to a period, by their numbers."""
    last = table[(table.cycle == table.period) & (table.period <= longest_period)].sort_values(["branch", "point"])
    return {
        int(number): Line(int(rows.period.iloc[0]), rows[["delta", "v", "acceleration"]].to_numpy())
        for number, rows in last.groupby("branch")
    }


def doubled_lines(
    parameters: np.ndarray, cascade: pd.DataFrame, longest: tuple[int, int], limits: tuple[float, float]
) -> list[Line]:
    """Branches of the jumping orbit's doublings whose periods lie between the longest stored and the longest wanted."""
    found = []
    for row in cascade.itertuples():
        period = 2 * int(row.period)
        if longest[0] < period <= longest[1] and limits[0] < row.acceleration < limits[1]:
            orbit = periodic_orbits.find_orbit(
                parameters, row.acceleration, np.array([row.delta, row.v]), int(row.period)
            )
            new = continuation.find_doubled_orbit(parameters, Bifurcation("period_doubling", orbit, -1.0))
            branch = continuation.follow_branch(parameters, new, limits).orbits
            found.append(Line(period, np.array([[*orbit.state, orbit.acceleration] for orbit in branch])))
    return found


def amplitudes(settings: dict) -> list[float]:
    """All amplitudes at which orbits are proved, m/s², ascending."""
    return sorted({*grid.axis_values("acceleration", settings["acceleration"]).tolist(), *settings["also"]})


def orbits_to_prove(settings: dict, branches: pd.DataFrame, cascade: pd.DataFrame) -> list[Known]:
    """All orbits up to the longest period at the amplitudes of the settings."""
    parameters, wanted = grid.packed(settings["model"]), amplitudes(settings)
    lines = stored_lines(branches, settings["longest_period"])
    periods = int(branches.period.max()), settings["longest_period"]
    more = doubled_lines(parameters, cascade, periods, (wanted[0], settings["doubled_limit"]))
    lines |= dict(enumerate(more, start=int(branches.branch.max()) + 1))
    return [
        found
        for acceleration in wanted
        for number, line in lines.items()
        for found in crossings(parameters, number, line, acceleration)
    ]


def ends(name: str, ball, unit=1) -> dict[str, float]:
    """Columns NAME_low and NAME_high of a ball in a unit, rounded outwards; null for None."""
    low, high = (np.nan, np.nan) if ball is None else bounds(ball * unit)
    return {f"{name}_low": low, f"{name}_high": high}


def certificate(units: Law, orbit: ProvedOrbit | None) -> dict:
    """The columns of an orbit that is proved; nulls for None."""
    columns = {}
    delta = v = duration = contact = trace = determinant = phase = speed = None
    multipliers = [(None, None)] * 2
    if orbit is not None:
        delta, y = orbit.strobe(0)
        v = y - units.beta * delta if delta > 0 else y
        duration, contact = orbit.duration / units.omega, orbit.contact / units.omega
        trace, determinant = orbit.trace, orbit.determinant
        with suppress(Refused):
            multipliers = orbit.multipliers()
        first = orbit.impacts[0] if orbit.impacts else None
        phase, speed = (first.phase, first.speed) if first else (None, None)
    columns |= ends("delta", delta, units.length) | ends("v", v, units.speed)
    columns |= ends("duration", duration) | ends("contact_time", contact)
    columns |= ends("impact_phase", phase) | ends("impact_speed", speed, units.speed)
    columns |= ends("trace", trace) | ends("determinant", determinant)
    for number, (real, imag) in enumerate(multipliers, start=1):
        columns |= ends(f"multiplier_{number}_real", real) | ends(f"multiplier_{number}_imag", imag)
    return columns


def prove_known(settings: dict, about: tuple) -> dict:
    """The row of one orbit."""
    (start,) = about
    float_orbit, problem = start.orbit, shooting(settings, start.orbit.period)
    row = {
        "branch": start.branch,
        "acceleration": float_orbit.acceleration,
        "period": float_orbit.period,
        "stored_delta": float_orbit.state[0],
        "stored_v": float_orbit.state[1],
        "bits": settings["bits"],
        "order": settings["order"],
    }
    orbit, reason = None, None
    try:
        orbit = prove_orbit(problem, problem.law.gamma(exactly(float_orbit.acceleration)), start.strobes)
        distance = check_near(orbit, start.strobes, settings["closeness"])
        columns = certificate(problem.law, orbit)
    except Refused as refused:
        orbit, reason, distance = None, str(refused), np.nan
        columns = certificate(problem.law, None)
    return {
        **row,
        **columns,
        "contained": orbit is not None,
        "reason": reason,
        "impacts": float_orbit.impacts if orbit is None else len(orbit.impacts),
        "stability": orbit.stability if orbit else "open",
        "half_width": orbit.half_width if orbit else np.nan,
        "distance": distance,
    }


def strobes_of(settings: dict, row) -> np.ndarray:
    """(δ, Y) at the beginnings of the cycles of an orbit of a table, in units of the law."""
    returns = ReturnMap(grid.packed(settings["model"]), int(row.period))
    return known(0, returns, returns.scaled(row.acceleration, np.array([row.delta, row.v]))).strobes


def prove_bifurcation(settings: dict, about: tuple) -> dict:
    """The row of one fold or doubling, given by its number and its row in a table."""
    kind, number, row = about
    problem, strobes = shooting(settings, int(row.period)), strobes_of(settings, row)
    try:
        if kind == "fold":
            found = bracket_fold(problem, row.acceleration, strobes, settings["half_arc"])
        else:
            found = bracket_doubling(problem, row.acceleration, strobes, settings["half_width"])
        acceleration, (begin, end), reason = found.acceleration, found.tests, None
    except Refused as refused:
        acceleration = begin = end = None
        reason = str(refused)
    return {
        "kind": kind,
        "number": number,
        "period": int(row.period),
        "stored_acceleration": row.acceleration,
        "proved": reason is None,
        "reason": reason,
        **ends("acceleration", acceleration),
        **ends("test_begin", begin),
        **ends("test_end", end),
        "bits": settings["bits"],
        "order": settings["order"],
    }


def prove_chaos(settings: dict, about: tuple) -> dict:
    """The row of one amplitude: a horseshoe at the orbit of one cycle with the largest multiplier that has one."""
    acceleration, saddles = about
    chaos, parameters, units = settings["chaos"], grid.packed(settings["model"]), law(settings)
    system = System(units, units.gamma(exactly(acceleration)), Accuracy(chaos["order"], chaos["tolerance"]))
    row = {
        "acceleration": acceleration,
        "proved": False,
        "reason": "there is no unstable orbit of one cycle",
        "sets": 0,
        "entropy": np.nan,
        "delta": np.nan,
        "v": np.nan,
        "bits": chaos["bits"],
        "order": chaos["order"],
    }
    for saddle in sorted(saddles, key=lambda saddle: -abs(saddle.orbit.multipliers[0])):
        try:
            fixed = np.append(saddle.strobes[0], acceleration)
            centres, axes = plan_sets(parameters, fixed, chaos["size"], chaos["ratio"], chaos["longest"])
            horseshoe = prove_horseshoe(system, centres, axes)
        except Refused as refused:
            row["reason"] = str(refused)
            continue
        state = dict(zip(("delta", "v"), saddle.orbit.state, strict=True))
        return {
            **row,
            **state,
            "proved": True,
            "reason": None,
            "sets": len(horseshoe.sets),
            "entropy": bounds(horseshoe.entropy)[0],
        }
    return row


def timed(settings: dict, work: Work) -> tuple[dict, float]:
    """What one piece of work finds, and the processor time that it takes in s."""
    begin = time.process_time()
    accuracy = settings["chaos"] if work.prove is prove_chaos else settings
    with precision(accuracy["bits"], accuracy["order"]):
        row = work.prove(settings, work.about)
    return row, time.process_time() - begin


def all_done(settings: dict, works: list[Work], processes: int) -> list[tuple[dict, float]]:
    """What all pieces of work find, in their order, by processes that share nothing."""
    with ProcessPoolExecutor(processes, mp_context=get_context("fork")) as pool:
        # The longest ones come last: they begin first, so that the processes end together.
        futures = [pool.submit(timed, settings, work) for work in reversed(works)]
        return [future.result() for future in bar(futures, label="certificates", unit="proofs")][::-1]


def numbered(table: pd.DataFrame) -> Iterator[tuple[int, SimpleNamespace]]:
    """The rows of a table with their numbers from 1 on, in a form that goes to other processes."""
    return enumerate((SimpleNamespace(**row) for row in table.to_dict("records")), start=1)


def works_of(settings: dict, stored: dict[str, pd.DataFrame]) -> list[Work]:
    """Everything to prove."""
    found = orbits_to_prove(settings, stored["branches"], stored["cascade"])
    first = stored["cascade"].iloc[0]
    bifurcations = stored["folds_and_doublings"]
    doublings = bifurcations[(bifurcations.kind == "period_doubling") & (bifurcations.period == first.period)]
    jumping = doublings.loc[(doublings.acceleration - first.acceleration).abs().idxmin()].branch
    folds = bifurcations[(bifurcations.kind == "fold") & (bifurcations.branch == jumping)]
    parameters = grid.packed(settings["model"])
    singles = stored_lines(stored["branches"], 1)
    chaotic = [
        (
            acceleration,
            [
                saddle
                for number, line in singles.items()
                for saddle in crossings(parameters, number, line, acceleration)
                if abs(saddle.orbit.multipliers[0]) > 1.0
            ],
        )
        for acceleration in settings["chaos"]["acceleration"]
    ]
    doubled = stored["cascade"].head(settings["doublings"])
    return [
        *(Work(prove_known, (orbit,)) for orbit in found),
        *(Work(prove_bifurcation, ("fold", n, row)) for n, row in numbered(folds)),
        *(Work(prove_bifurcation, ("period_doubling", n, row)) for n, row in numbered(doubled)),
        *(Work(prove_chaos, about) for about in chaotic),
    ]


PROVERS = {
    "certificates": prove_known,
    "certified_bifurcations": prove_bifurcation,
    "certified_chaos": prove_chaos,
}


def make(
    settings: dict,
    branches: pd.DataFrame,
    folds_and_doublings: pd.DataFrame,
    cascade: pd.DataFrame,
    *,
    threads: int = 1,
) -> dict[str, dict[str, np.ndarray]]:
    """The columns of the four tables, by their kinds, for the section `certificates` of the config."""
    stored = {"branches": branches, "folds_and_doublings": folds_and_doublings, "cascade": cascade}
    works = works_of(settings, stored)
    done = all_done(settings, works, threads)
    kind_of = {prover: kind for kind, prover in PROVERS.items()}
    rows: dict[str, list[dict]] = {kind: [] for kind in TABLES}
    for work, (row, seconds) in zip(works, done, strict=True):
        kind = kind_of[work.prove]
        rows[kind].append(row)
        rows["certificate_times"].append(
            {
                "kind": kind,
                "acceleration": row.get("acceleration", row.get("stored_acceleration")),
                "period": row.get("period", 1),
                "impacts": row.get("impacts", 0),
                "seconds": seconds,
            }
        )
    return {kind: fields.columns(of_kind, TABLES[kind]) for kind, of_kind in rows.items()}
