"""Sect. 3 of the paper: states of motion, their velocities, critical heights, spectra and maps."""

from collections.abc import Callable

import numpy as np
import pandas as pd

from findings import proofs
from findings.finding import NONE, Finding, highest, lowest, onset

MM = 1e3
LINE = 0.02  # of the largest amplitude: what a reader sees as a line in a spectrum


def second_from_rest(table: pd.DataFrame) -> float:
    """Lowest amplitude (m/s²) at which the start z0 = 0 does not end in the first state."""
    return lowest(table[(table.z0 == 0.0) & (table.state != "first")].acceleration)


def critical_acceleration(tables: dict[str, pd.DataFrame]) -> Finding:
    """C01."""
    return Finding(*((second_from_rest(tables[role]),) for role in ("published", "converged")))


def two_states(table: pd.DataFrame) -> tuple[float, float]:
    """Ends of the interval of amplitudes (m/s²) at which some starts end in the first state and some in the second."""
    kinds = table.groupby("acceleration").state.agg(set)
    both = pd.Series([x for x, states in kinds.items() if {"first", "second"} <= states], dtype=float)
    return lowest(both), highest(both)


def readings(table: pd.DataFrame, text: Callable[[pd.DataFrame], str]) -> str:
    """What `text` says of each reading of the contact force, with which a sweep has been made."""
    return ", ".join(f"{text(rows)} ({mode})" for mode, rows in table.groupby("tension"))


def interval(tables: dict[str, pd.DataFrame]) -> Finding:
    """C02 and C10."""
    published, converged = two_states(tables["published"]), two_states(tables["converged"])
    table = tables["converged"]
    at_end = table[(table.acceleration == converged[1]) & (table.state == "first")]
    reason = (
        f"with the starts of the config both states exist from {converged[0]:g} to {converged[1]:g} m/s²; at the "
        f"upper end {len(at_end)} of {(table.acceleration == converged[1]).sum()} starts still end in the first state, "
        f"up to z0 = {MM * highest(at_end.z0):.3g} mm"
    )
    if "tension" in tables:
        found = readings(tables["tension"], lambda rows: "{:g} to {:g} m/s²".format(*two_states(rows)))
        reason += f"; by the reading of a contact force that pulls, with two starts only: {found}"
    return Finding(published, converged, reason + proofs.both_states(tables))


def scatter_onset(table: pd.DataFrame, spread: float = 0.05) -> float:
    """Lowest amplitude (m/s²) from which on the velocities of one amplitude's starts scatter, first state left out."""
    jumping = table[table.state != "first"].groupby("acceleration").mean_velocity
    relative = (jumping.std() / jumping.mean())[jumping.count() > 1]
    quiet = relative.index[relative <= spread]
    return lowest(relative.index[relative.index > (quiet.max() if len(quiet) else -np.inf)])


def chaos_onset(table: pd.DataFrame) -> float:
    """Amplitude (m/s²) from which on most starts settle to chaos."""
    share = (table.state == "chaos").groupby(table.acceleration).mean()
    return onset(share.index.to_numpy(), (share > 0.5).to_numpy())


def onset_of_chaos(tables: dict[str, pd.DataFrame]) -> Finding:
    """C03: the published protocol looks for velocities that scatter; the converged solution for settled motion that is
    chaotic.
    """
    converged = tables["converged"]
    scatter, chaos = scatter_onset(tables["published"]), chaos_onset(converged)
    reason = (
        f"the velocities of a run scatter from {scatter:g} m/s² on by Euler and from {scatter_onset(converged):g} m/s² "
        f"on in the converged solution; most settled motions are chaotic from {chaos:g} m/s² on"
    )
    between = converged[(converged.acceleration >= scatter) & (converged.acceleration < chaos)]
    if len(between):
        periods = ", ".join(
            f"period {period} for {100 * share:.0f} %"
            for period, share in between[between.period > 0].period.value_counts(normalize=True).head(3).items()
        )
        reason += (
            f", while in between {100 * (between.period > 0).mean():.0f} % of the starts settle to a period ({periods})"
        )
    return Finding((scatter,), (chaos,), reason + proofs.regular(tables, scatter))


def critical_at(table: pd.DataFrame, acceleration: float) -> float:
    """Critical initial height (m) at an amplitude, between the amplitudes of the table by a straight line."""
    rows = table[table.is_critical]
    return float(np.interp(acceleration, rows.acceleration, rows.z0, left=NONE, right=NONE))


def largest_critical_height(tables: dict[str, pd.DataFrame]) -> Finding:
    """C04, at the lower end of the paper's interval."""
    found = [MM * critical_at(tables[role], 29.0) for role in ("published", "converged")]
    table = tables["converged"]
    top = table.loc[table[table.is_critical].z0.idxmax()] if table.is_critical.any() else None
    reason = f"the critical height is steep in â there: converged {found[1]:.4g} mm at 29 m/s²" + (
        f" and {MM * top.z0:.4g} mm at {top.acceleration:g} m/s², the lowest amplitude with a second state; the state "
        f"changes more than once over z0 at {table[table.crossing > 1].acceleration.nunique()} of "
        f"{table.acceleration.nunique()} amplitudes"
        if top is not None
        else ""
    )
    return Finding((found[0],), (found[1],), reason)


def critical_height(acceleration: float):
    """C07 and C08: the critical height (mm) at one amplitude."""

    def finding(tables: dict[str, pd.DataFrame]) -> Finding:
        return Finding(*((MM * critical_at(tables[role], acceleration),) for role in ("published", "converged")))

    return finding


def velocities(table: pd.DataFrame, state: str) -> tuple[float, float]:
    """Median velocity (cm/s) of one state at the lowest and the highest amplitude of the table that has both states."""
    low, high = two_states(table)
    rows = table[table.state == state]
    return tuple(100.0 * float(rows[rows.acceleration == end].mean_velocity.median()) for end in (low, high))


def relative(value: float, reference: float) -> float:
    """Deviation of a value from its reference in percent."""
    return 100.0 * (value / reference - 1.0)


def first_velocity(tables: dict[str, pd.DataFrame]) -> Finding:
    """C05."""
    published, converged = (velocities(tables[role], "first") for role in ("published", "converged"))
    found = readings(
        tables["tension"], lambda rows: f"{100.0 * highest(rows[rows.state == 'first'].mean_velocity):.2f} cm/s"
    )
    reason = (
        f"it rises by {converged[1] - converged[0]:.2f} cm/s; Euler is {relative(published[1], converged[1]):+.1f} % "
        f"off at the upper end; at any amplitude its largest is, by the reading of a contact force that pulls: {found}"
    )
    return Finding(published, converged, reason)


def second_velocity(tables: dict[str, pd.DataFrame]) -> Finding:
    """C06."""
    ends = {role: velocities(tables[role], "second") for role in ("published", "converged")}
    falls = {role: first - last for role, (first, last) in ends.items()}
    table = tables["converged"]
    medians = 100.0 * table[table.state == "second"].groupby("acceleration").mean_velocity.median()
    found = readings(tables["tension"], lambda rows: "{:.2f} to {:.2f} cm/s".format(*velocities(rows, "second")))
    least = f"its least value, {medians.min():.2f} cm/s, is at {medians.idxmin():g} m/s²; " if len(medians) else ""
    reason = (
        f"it falls from {ends['converged'][0]:.2f} to {ends['converged'][1]:.2f} cm/s; {least}"
        f"by the reading of a contact force that pulls, each over its own interval: {found}"
    )
    return Finding((falls["published"],), (falls["converged"],), reason)


def fit(tables: dict[str, pd.DataFrame]) -> Finding:
    """C09."""
    rows = {role: tables[role].set_index("fit").loc["pymoo"] for role in ("published", "converged")}
    found = [tuple(float(row[name]) for name in ("A", "B", "C", "error")) for row in rows.values()]
    table = tables["converged"]
    triple = float(table.set_index("fit").loc["published"].error)
    valley = table[(table.fit == "valley") & (table.error <= triple)]
    reason = (
        f"A, B and C lie in a valley: on the converged heights the paper's triple has the error {triple:.3g} m², "
        f"the best one {found[1][3]:.3g} m², and every B from {valley.B.min():.3g} to {valley.B.max():.3g} m/s² "
        f"with its best A and C fits no worse than the paper's"
    )
    return Finding(found[0], found[1], reason)


def one_onset(tables: dict[str, pd.DataFrame]) -> Finding:
    """C11: how far apart (m/s²) the onsets of chaos of the single initial heights lie.

    Euler has no say: runs of both methods are followed by the converged solution until their state is clear.
    """
    table = tables["converged"]
    onsets = np.array([onset(rows.acceleration.to_numpy(), rows.state == "chaos") for _, rows in table.groupby("z0")])
    reason = f"the onsets lie between {onsets.min():.2f} and {onsets.max():.2f} m/s²"
    below = table[table.acceleration < onsets.min()]
    early = below[below.state == "chaos"]
    if len(early):
        low, high = early.acceleration.min(), early.acceleration.max()
        share = (table[table.acceleration.between(low, high)].state == "chaos").mean()
        reason += (
            f"; chaos that does depend on z0 occurs from {low:.2f} to {high:.2f} m/s² already, "
            f"for {100 * share:.0f} % of the starts there"
        )
    return Finding((), (float(np.ptp(onsets)),), reason)


def impact_line(tables: dict[str, pd.DataFrame]) -> Finding:
    """C12: slope (s/m) of the impact phase over the impact velocity, and the largest distance from the line (rad)."""
    rows = tables["converged"].dropna(subset="impact_velocity")
    slope, base = np.polyfit(rows.impact_velocity, rows.impact_phase, 1)
    distance = np.abs(slope * rows.impact_velocity + base - rows.impact_phase).max()
    return Finding((), (float(slope), float(distance)))


def lines(table: pd.DataFrame, signal: str) -> tuple[int, int, float]:
    """Numbers of lines above zero frequency in the first and the second state; mean over largest line in the second.

    A line counts from LINE times the largest amplitude of its spectrum on.
    """
    spectra = [rows for _, rows in table[table.signal == signal].groupby("acceleration")]
    counts = [int((rows[rows.frequency > 0.0].amplitude > LINE * rows.amplitude.max()).sum()) for rows in spectra]
    second = spectra[-1]
    ratio = second[second.frequency == 0.0].amplitude.max() / second[second.frequency > 0.0].amplitude.max()
    return counts[0], counts[-1], float(ratio)


def vertical_lines(tables: dict[str, pd.DataFrame]) -> Finding:
    """C13: how many more lines ż_p has in the second state than in the first."""
    found = [lines(tables[role], "vz") for role in ("published", "converged")]
    return Finding(*((float(second - first),) for first, second, _ in found))


def horizontal_lines(tables: dict[str, pd.DataFrame]) -> Finding:
    """C14: how many more lines ẋ_p has in the first state than in the second, and the second's mean over its lines."""
    found = [lines(tables[role], "vx") for role in ("published", "converged")]
    return Finding(*((float(first - second), ratio) for first, second, ratio in found))


def overlap(tables: dict[str, pd.DataFrame]) -> Finding:
    """C17: share of the higher map's first state that is first state in the lower one, and the higher map's chaos."""
    shares = []
    for place in ("height", "velocity"):
        low, high = tables[f"{place}_low"].state.to_numpy(), tables[f"{place}_high"].state.to_numpy()
        first = high == "first"
        shares += [float((low[first] == "first").mean()) if first.any() else NONE, float((high == "chaos").mean())]
    chaotic = sum(int((tables[f"{place}_low"].state == "chaos").sum()) for place in ("height", "velocity"))
    reason = f"{chaotic} points of both maps at the lower amplitude are chaotic"
    return Finding((), tuple(shares), reason)


def mapped(tables: dict[str, pd.DataFrame]) -> Finding:
    """C23: share of the starts in the air whose images on the plate lead to the same state."""
    rows = tables["converged"].dropna(subset="mapped_state")
    return Finding((), (float((rows.state == rows.mapped_state).mean()),))


def euler_error(tables: dict[str, pd.DataFrame]) -> Finding:
    """C22: median relative errors of Euler's mean velocity in the first and in the second state, where both methods
    lead to the same motion with the period of the excitation, and share of the amplitudes of Fig. 22 at which its
    estimate has the right sign.
    """
    published, converged = tables["published"], tables["converged"]
    regular = ((converged.period == 1) & (published.period == 1) & (converged.state == published.state)).to_numpy()
    signed = (published.mean_velocity / converged.mean_velocity - 1.0)[regular]
    errors = signed.abs().groupby(converged.state[regular]).median().reindex(["first", "second"])
    exponent = tables["converged_exponent"]
    right = np.sign(tables["published_exponent"]["lambda"]) == np.sign(exponent["lambda"])
    wrong = exponent[~right].acceleration
    reason = (
        f"{len(signed)} runs of period 1 are compared, of which Euler feeds {100 * (signed < 0.0).mean():.0f} % too "
        f"slowly; the sign of the estimate is wrong at {len(wrong)} of {len(right)} amplitudes"
    ) + (f", half of them between {wrong.quantile(0.25):.1f} and {wrong.quantile(0.75):.1f} m/s²" if len(wrong) else "")
    return Finding((*map(float, errors), float(right.mean())), (), reason)
