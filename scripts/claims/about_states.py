"""Sect. 3 of the paper: states of motion, their velocities, critical heights, spectra and maps."""

from collections.abc import Callable, Iterable

import numpy as np
import pandas as pd

from claims import about_proofs
from claims.finding import METHODS, NONE, Finding, by_both, by_method, format_value, highest, lowest, onset

MM = 1e3
LINE = 0.02  # of the largest amplitude: what a reader sees as a line in a spectrum


def second_from_rest(table: pd.DataFrame) -> float:
    """Lowest amplitude (m/s²) at which the start z0 = 0 does not end in the first state."""
    return lowest(table[(table.z0 == 0.0) & (table.state != "first")].acceleration)


def critical_acceleration(*, euler: pd.DataFrame, converged: pd.DataFrame) -> Finding:
    return by_both("critical_amplitude", second_from_rest, euler, converged)


def two_states(table: pd.DataFrame) -> tuple[float, float]:
    """Ends of the interval of amplitudes (m/s²) at which some starts end in the first state and some in the second."""
    kinds = table.groupby("acceleration").state.agg(set)
    both = pd.Series([x for x, states in kinds.items() if {"first", "second"} <= states], dtype=float)
    return lowest(both), highest(both)


def readings(table: pd.DataFrame, text: Callable[[pd.DataFrame], str]) -> str:
    """What `text` says of each reading of the contact force, with which a sweep has been made."""
    return ", ".join(f"{text(rows)} ({mode})" for mode, rows in table.groupby("tension"))


def interval(
    *,
    euler: pd.DataFrame,
    converged: pd.DataFrame,
    tension: pd.DataFrame | None = None,
    certificates: pd.DataFrame | None = None,
) -> Finding:
    ends = by_method(two_states, euler, converged)
    low, high = ends["converged"]
    starts = converged[converged.acceleration == high]
    at_end = starts[starts.state == "first"]
    note = (
        f"with the starts of the config both states exist from {format_value(low)} to {format_value(high)}; at the "
        f"upper end {len(at_end)} of {len(starts)} starts still end in the first state, up to "
        f"z0 = {MM * highest(at_end.z0):.3g} mm"
    )
    if tension is not None:
        found = readings(tension, lambda rows: "{:g} to {:g} m/s²".format(*two_states(rows)))
        note += f"; by the reading of a contact force that pulls, with two starts only: {found}"
    quantities = ({"lower_end": lower, "upper_end": upper} for lower, upper in ends.values())
    return Finding(*quantities, note + about_proofs.both_states(certificates))


def scatter_onset(table: pd.DataFrame, spread: float = 0.05) -> float:
    """Lowest amplitude (m/s²) from which on the velocities of one amplitude's starts scatter, first state left out."""
    jumping = table[table.state != "first"].groupby("acceleration").mean_velocity
    relative = (jumping.std() / jumping.mean())[jumping.count() > 1]
    quiet = relative.index[relative <= spread]
    return lowest(relative.index[relative.index > (quiet.max() if len(quiet) else -np.inf)])


def chaos_onset(table: pd.DataFrame) -> float:
    """Amplitude (m/s²) from which on most starts have not settled and have a positive exponent."""
    share = (table.state == "chaos").groupby(table.acceleration).mean()
    return onset(share.index.to_numpy(), (share > 0.5).to_numpy())


def onset_of_chaos(
    *, euler: pd.DataFrame, converged: pd.DataFrame, certificates: pd.DataFrame | None = None
) -> Finding:
    """Read as the paper reads it, off velocities that scatter, by either method."""
    scatter = by_method(scatter_onset, euler, converged)
    chaos = by_method(chaos_onset, euler, converged)
    note = (
        f"what a reader sees is scatter; most starts settle to chaos from {format_value(chaos['converged'])} on "
        f"({format_value(chaos['euler'])} where the paper's method leaves them)"
    )
    between = converged[
        (converged.acceleration >= scatter["converged"]) & (converged.acceleration < chaos["converged"])
    ]
    if len(between):
        periods = ", ".join(
            f"period {period} for {100 * share:.0f} %"
            for period, share in between[between.period > 0].period.value_counts(normalize=True).head(3).items()
        )
        note += (
            f", while in between {100 * (between.period > 0).mean():.0f} % of the starts settle to a period ({periods})"
        )
    proved = about_proofs.regular(certificates, scatter["converged"])
    return Finding(*({"onset": scatter[method]} for method in METHODS), note + proved)


def critical_at(table: pd.DataFrame, acceleration: float) -> float:
    """Critical initial height (m) at an amplitude, between the amplitudes of the table by a straight line."""
    rows = table[table.is_critical]
    return float(np.interp(acceleration, rows.acceleration, rows.z0, left=NONE, right=NONE))


def largest_critical_height(*, euler: pd.DataFrame, converged: pd.DataFrame, heights: pd.DataFrame) -> Finding:
    """Over the amplitudes of Fig. 9."""
    amplitudes = np.sort(heights.acceleration.unique())
    found = by_method(
        lambda table: pd.Series([MM * critical_at(table, one) for one in amplitudes], amplitudes), euler, converged
    )
    critical = converged[converged.is_critical]
    top = critical.loc[critical.z0.idxmax()] if len(critical) else None
    where = found["converged"].idxmax() if found["converged"].notna().any() else NONE
    note = f"it is that at {format_value(where)}, where the height is steep in the amplitude" + (
        f": converged {MM * top.z0:.4g} mm at {top.acceleration:g} m/s², the lowest amplitude with a second state; the "
        f"state changes more than once over z0 at {converged[converged.crossing > 1].acceleration.nunique()} of "
        f"{converged.acceleration.nunique()} amplitudes"
        if top is not None
        else ""
    )
    return Finding(*({"largest_height": highest(found[method])} for method in METHODS), note)


def critical_height(*, euler: pd.DataFrame, converged: pd.DataFrame, acceleration: float) -> Finding:
    """The critical height (mm) at one amplitude (m/s²)."""
    return by_both("height", lambda table: MM * critical_at(table, acceleration), euler, converged)


def velocities(table: pd.DataFrame, state: str) -> tuple[float, float]:
    """Median velocity (cm/s) of one state at the lowest and the highest amplitude of the table that has both states."""
    low, high = two_states(table)
    rows = table[table.state == state]
    return tuple(100.0 * float(rows[rows.acceleration == end].mean_velocity.median()) for end in (low, high))


def relative(value: float, reference: float) -> float:
    """Deviation of a value from its reference in percent."""
    return 100.0 * (value / reference - 1.0)


def first_velocity(*, euler: pd.DataFrame, converged: pd.DataFrame, tension: pd.DataFrame) -> Finding:
    ends = by_method(lambda table: velocities(table, "first"), euler, converged)
    found = readings(tension, lambda rows: f"{100.0 * highest(rows[rows.state == 'first'].mean_velocity):.2f} cm/s")
    low, high = ends["converged"]
    note = (
        f"it rises by {high - low:.2f} cm/s; the paper's method is {relative(ends['euler'][1], high):+.1f} % off at "
        f"the upper end; at any amplitude its largest is, by the reading of a contact force that pulls: {found}"
    )
    return Finding(
        *(
            dict(zip(("velocity_at_lower_end", "velocity_at_upper_end"), ends[method], strict=True))
            for method in METHODS
        ),
        note,
    )


def second_velocity(*, euler: pd.DataFrame, converged: pd.DataFrame, tension: pd.DataFrame) -> Finding:
    ends = by_method(lambda table: velocities(table, "second"), euler, converged)
    medians = 100.0 * converged[converged.state == "second"].groupby("acceleration").mean_velocity.median()
    found = readings(tension, lambda rows: "{:.2f} to {:.2f} cm/s".format(*velocities(rows, "second")))
    least = f"its least value, {medians.min():.2f} cm/s, is at {medians.idxmin():g} m/s²; " if len(medians) else ""
    note = (
        f"it falls from {ends['converged'][0]:.2f} to {ends['converged'][1]:.2f} cm/s; {least}"
        f"by the reading of a contact force that pulls, each over its own interval: {found}"
    )
    return Finding(*({"fall": ends[method][0] - ends[method][1]} for method in METHODS), note)


def fit(*, euler: pd.DataFrame, converged: pd.DataFrame) -> Finding:

    def best(table: pd.DataFrame) -> dict[str, float]:
        row = table.set_index("fit").loc["pymoo"]
        return {name: float(row[name]) for name in ("A", "B", "C", "error")}

    found = by_method(best, euler, converged)
    triple = float(converged.set_index("fit").loc["paper"].error)
    valley = converged[(converged.fit == "valley") & (converged.error <= triple)]
    note = (
        f"A, B and C lie in a valley: on the converged heights the paper's triple has the error {triple:.3g} m², "
        f"the best one {found['converged']['error']:.3g} m², and every B from {valley.B.min():.3g} to "
        f"{valley.B.max():.3g} m/s² with its best A and C fits no worse than the paper's"
    )
    return Finding(found["euler"], found["converged"], note)


def runs_of(x: Iterable[float], chosen: Iterable[bool]) -> list[tuple[float, float]]:
    """First and last x of each run of neighbours that are chosen; x is ascending."""
    x, flags = np.asarray(list(x)), np.concatenate([[False], np.asarray(list(chosen), dtype=bool), [False]])
    edges = np.flatnonzero(flags[1:] != flags[:-1])
    return [(float(x[begin]), float(x[end - 1])) for begin, end in zip(edges[::2], edges[1::2], strict=True)]


def written_runs(runs: list[tuple[float, float]], most: int = 4) -> str:
    """Runs of amplitudes in words, the longest ones first in rank and in ascending order."""
    longest = sorted(sorted(runs, key=lambda run: run[0] - run[1])[:most])
    text = ", ".join(f"{low:.2f}" if low == high else f"{low:.2f} to {high:.2f}" for low, high in longest) + " m/s²"
    return text if len(runs) <= most else f"{text} and {len(runs) - most} shorter ones"


def one_onset(*, converged: pd.DataFrame) -> Finding:
    """How far apart (m/s²) the onsets of chaos of the single initial heights lie.

    The paper's method has no say: runs of both methods are followed by the converged solution until they are clear.
    """
    starts = converged.groupby("z0")
    onsets = np.array([onset(rows.acceleration.to_numpy(), rows.state == "chaos") for _, rows in starts])
    share = (converged.state == "chaos").groupby(converged.acceleration).mean()
    beside = runs_of(share.index, (share > 0.0) & (share < 1.0))
    regular = share.index[share < 1.0]
    note = f"the onsets lie between {format_value(onsets.min())} and {format_value(onsets.max())}"
    if beside:
        note += f"; chaos beside regular motion, by the initial height, from {written_runs(beside)}"
    if len(regular):
        windows = runs_of(share.index, (share < 1.0) & (share.index > onsets.max()))
        note += "; above the onset regular motion is left " + (
            f"in windows only: {written_runs(windows)}" if windows else "nowhere"
        )
    return Finding({}, {"spread": float(np.ptp(onsets))}, note)


def impact_line(*, converged: pd.DataFrame) -> Finding:
    """Slope (s/m) of the impact phase over the impact velocity, and the largest distance from the line (rad)."""
    rows = converged.dropna(subset="impact_velocity")
    slope, base = np.polyfit(rows.impact_velocity, rows.impact_phase, 1)
    distance = np.abs(slope * rows.impact_velocity + base - rows.impact_phase).max()
    return Finding({}, {"slope": float(slope), "distance": float(distance)})


def lines(table: pd.DataFrame, signal: str) -> tuple[int, int, float]:
    """Numbers of lines above zero frequency in the first and the second state; mean over largest line in the second.

    A line counts from LINE times the largest amplitude of its spectrum on.
    """
    spectra = [rows for _, rows in table[table.signal == signal].groupby("acceleration")]
    counts = [int((rows[rows.frequency > 0.0].amplitude > LINE * rows.amplitude.max()).sum()) for rows in spectra]
    second = spectra[-1]
    ratio = second[second.frequency == 0.0].amplitude.max() / second[second.frequency > 0.0].amplitude.max()
    return counts[0], counts[-1], float(ratio)


def vertical_lines(*, euler: pd.DataFrame, converged: pd.DataFrame) -> Finding:
    def more(table):
        first, second, _ = lines(table, "vz")
        return second - first

    return by_both("more_lines", more, euler, converged)


def horizontal_lines(*, euler: pd.DataFrame, converged: pd.DataFrame) -> Finding:
    found = by_method(lambda table: lines(table, "vx"), euler, converged)
    return Finding(
        *({"more_lines": float(first - second), "mean_over_line": ratio} for first, second, ratio in found.values())
    )


def overlap(
    *, height_low: pd.DataFrame, height_high: pd.DataFrame, velocity_low: pd.DataFrame, velocity_high: pd.DataFrame
) -> Finding:
    """Share of the higher map's first state that is first state in the lower one, and the higher map's chaos."""
    shares = {}
    maps = {"height": (height_low, height_high), "velocity": (velocity_low, velocity_high)}
    for place, (lower, higher) in maps.items():
        low, high = lower.state.to_numpy(), higher.state.to_numpy()
        first = high == "first"
        shares[f"shared_{place}"] = float((low[first] == "first").mean()) if first.any() else NONE
        shares[f"chaos_{place}"] = float((high == "chaos").mean())
    chaotic = sum(int((table.state == "chaos").sum()) for table in (height_low, velocity_low))
    return Finding({}, shares, f"{chaotic} points of both maps at the lower amplitude are chaotic")


def mapped(*, converged: pd.DataFrame) -> Finding:
    """Share of the starts in the air whose images on the plate lead to the same state."""
    rows = converged.dropna(subset="mapped_state")
    return Finding({}, {"equal": float((rows.state == rows.mapped_state).mean()) if len(rows) else NONE})


def euler_error(
    *, euler: pd.DataFrame, converged: pd.DataFrame, euler_exponent: pd.DataFrame, converged_exponent: pd.DataFrame
) -> Finding:
    """Median relative errors of Euler's mean velocity in the first and in the second state, where both methods lead to
    the same motion with the period of the excitation, and share of the amplitudes of Fig. 22 at which its estimate has
    the right sign.
    """
    regular = ((converged.period == 1) & (euler.period == 1) & (converged.state == euler.state)).to_numpy()
    signed = (euler.mean_velocity / converged.mean_velocity - 1.0)[regular]
    errors = signed.abs().groupby(converged.state[regular]).median().reindex(["first", "second"])
    right = np.sign(euler_exponent["lambda"]) == np.sign(converged_exponent["lambda"])
    wrong = converged_exponent[~right].acceleration
    note = (
        f"{len(signed)} runs of period 1 are compared, of which Euler feeds {100 * (signed < 0.0).mean():.0f} % too "
        f"slowly; the sign of the estimate is wrong at {len(wrong)} of {len(right)} amplitudes"
    ) + (f", half of them between {wrong.quantile(0.25):.1f} and {wrong.quantile(0.75):.1f} m/s²" if len(wrong) else "")
    found = {"first_error": float(errors["first"]), "second_error": float(errors["second"])}
    return Finding(found | {"right_signs": float(right.mean())}, {}, note)
