"""Sect. 3 of the paper: states of motion, their velocities, critical heights, spectra and maps."""

import operator
from collections.abc import Callable

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from conveyor.linear_algebra import fit_line
from conveyor_pipeline.paper.claims import about_proofs
from conveyor_pipeline.paper.claims.about_chaos import with_settled_motion
from conveyor_pipeline.paper.claims.finding import NONE, Finding, by_method, format_amplitude, onset, single_quantity
from conveyor_pipeline.paper.fit import hyperbola

MM = 1e3
LINE = 0.02  # smallest visible line of a spectrum, over its largest amplitude
SCATTER = 0.05  # largest relative standard deviation of velocities that do not scatter


def second_from_rest(table: pd.DataFrame) -> float:
    """Lowest amplitude (m/s²) at which the initial height z0 = 0 does not lead to the first state."""
    return table[(table.z0 == 0.0) & (table.state != "first")].acceleration.min()


def critical_acceleration(*, euler: pd.DataFrame, converged: pd.DataFrame) -> Finding:
    """Lowest amplitude (m/s²) at which a part from rest does not stay in the first state."""
    return single_quantity("critical_amplitude", second_from_rest, euler, converged)


def influences(*, changes: pd.DataFrame, frictions: pd.DataFrame) -> Finding:
    """Absolute elasticities of the critical amplitude: its relative change over the relative change of a parameter.

    changes : of the critical amplitude of a part from rest with the parameters of the motion normal to the track
    frictions : states of parts from rest over friction and amplitude, because friction is no parameter of that motion
    """
    rows = changes[(changes.kind == "critical_amplitude") & (changes.status == "ok")]
    elasticities = rows.set_index("parameter").elasticity.abs()
    critical = pd.Series({friction: second_from_rest(rows) for friction, rows in frictions.groupby("friction")})
    span = critical.index.max() / critical.index.min()
    quantities = {name: float(elasticities.get(name, NONE)) for name in ("mass", "stiffness", "damping")}
    quantities["friction"] = float(np.log(critical.max() / critical.min()) / np.log(span)) if span > 1.0 else NONE
    note = (
        f"With every friction from {critical.index.min():g} to {critical.index.max():g}, the critical amplitude lies "
        f"at {format_amplitude(critical.min())}. In the model, friction acts along the track only, and the state of "
        "motion is a property of the motion normal to the track, which does not depend on the friction at all"
    )
    return Finding({}, quantities, note)


def two_states(table: pd.DataFrame) -> tuple[float, float]:
    """Ends of the interval of amplitudes (m/s²) at which the first and the second state coexist."""
    kinds = table.groupby("acceleration").state.agg(set)
    shared = pd.Series([x for x, states in kinds.items() if {"first", "second"} <= states], dtype=float)
    return shared.min(), shared.max()


def describe_tensions(table: pd.DataFrame, describe: Callable[[pd.DataFrame], str]) -> str:
    """What `describe` says about the rows of each tension mode, in one line."""
    return ", ".join(f"{describe(rows)} ({mode})" for mode, rows in table.groupby("tension"))


def interval(
    *,
    euler: pd.DataFrame,
    converged: pd.DataFrame,
    tension: pd.DataFrame | None = None,
    certificates: pd.DataFrame | None = None,
    heights: pd.DataFrame | None = None,
) -> Finding:
    """Ends of the interval of amplitudes (m/s²) at which both states coexist.

    With `heights`, also the ends that are found if only amplitudes in the steps of that table are computed.
    """
    ends = by_method(two_states, euler, converged)
    low, high = ends["converged"]
    at_end = converged[converged.acceleration == high]
    first = at_end[at_end.state == "first"]
    note = (
        f"With the initial heights of the config, both states exist from {format_amplitude(low)} to "
        f"{format_amplitude(high)}. At the upper end, the first state is still reached from {len(first)} of "
        f"{len(at_end)} initial heights; the largest of them is {MM * first.z0.max():.3g} mm"
    )
    if tension is not None:
        described = describe_tensions(tension, lambda rows: "{:g} to {:g} m/s²".format(*two_states(rows)))
        note += f". With two initial heights, for each treatment of a tensile contact force: {described}"
    quantities = [{"lower_end": lower, "upper_end": upper} for lower, upper in ends.values()]
    if heights is not None:
        coarse = by_method(lambda table: two_states(in_steps_of(table, heights)), euler, converged)
        for by_fine_axis, (lower, upper) in zip(quantities, coarse.values(), strict=True):
            by_fine_axis |= {"coarse_lower_end": lower, "coarse_upper_end": upper}
        critical = second_from_rest(in_steps_of(converged, heights))
        note += (
            f". The steps of the paper's axis are unknown. In steps of {amplitude_step(heights):g} m/s², which are "
            f"assumed for Fig. 9, the part from rest changes its state at {format_amplitude(critical)}"
        )
    return Finding(*quantities, note + about_proofs.describe_coexistence(certificates))


def amplitude_step(table: pd.DataFrame) -> float:
    """The distance (m/s²) between the amplitudes of a table with equal steps."""
    return float(np.diff(np.sort(table.acceleration.unique())).mean())


def in_steps_of(table: pd.DataFrame, coarse: pd.DataFrame) -> pd.DataFrame:
    """The rows whose amplitudes lie on the axis of a coarser table, continued beyond its ends."""
    steps = (table.acceleration - coarse.acceleration.min()) / amplitude_step(coarse)
    return table[np.isclose(steps, steps.round(), rtol=0.0, atol=1e-6)]


def relative_scatter(table: pd.DataFrame) -> pd.Series:
    """Relative standard deviation of the velocities outside the first state, by the amplitude (m/s²)."""
    jumping = table[table.state != "first"].groupby("acceleration").mean_velocity
    return (jumping.std() / jumping.mean())[jumping.count() > 1]


def scatter_onset(table: pd.DataFrame) -> float:
    """Lowest amplitude (m/s²) from which on velocities outside the first state scatter at all amplitudes."""
    relative = relative_scatter(table)
    quiet = relative.index[relative <= SCATTER]
    return relative.index[relative.index > (quiet.max() if len(quiet) else -np.inf)].min()


def chaos_onset(table: pd.DataFrame) -> float:
    """Amplitude (m/s²) from which most initial conditions lead to chaos."""
    share = (table.state == "chaos").groupby(table.acceleration).mean()
    return onset(share.index, share > 0.5)


def onset_of_chaos(*, euler: pd.DataFrame, converged: pd.DataFrame, certificates: pd.DataFrame) -> Finding:
    """Amplitudes (m/s²) from which velocities scatter, which the paper reads as chaos, and motions are chaotic."""
    scatter = by_method(scatter_onset, euler, converged)
    chaos = by_method(chaos_onset, euler, converged)
    end = two_states(converged)[1]
    relative = relative_scatter(converged)
    before = relative[(relative.index > end) & (relative.index < scatter["converged"])]
    also = (
        f", and at {(before > SCATTER).sum()} of {len(before)} amplitudes between there and {format_amplitude(end)}, "
        "the end of the interval of two states"
        if len(before)
        else ""
    )
    note = (
        f"From {format_amplitude(scatter['converged'])} on, velocities scatter at all amplitudes{also}. Most motions "
        f"settle to chaos only from {format_amplitude(chaos['converged'])} on"
    )
    between = converged[converged.acceleration.between(scatter["converged"], chaos["converged"], inclusive="left")]
    if len(between):
        periods = ", ".join(
            f"period {period} for {100 * share:.0f} %"
            for period, share in between[between.period > 0].period.value_counts(normalize=True).head(3).items()
        )
        note += (
            f". Between these amplitudes, {100 * (between.period > 0).mean():.0f} % of the motions settle to a "
            f"periodic motion ({periods})"
        )
    proved = about_proofs.describe_periodic(certificates, scatter["converged"])
    quantities = ({"scatter": scatter[method], "onset": chaos[method]} for method in scatter)
    return Finding(*quantities, note + proved)


def critical_at(table: pd.DataFrame, acceleration: float) -> float:
    """Critical initial height (m) at an amplitude, by linear interpolation between the amplitudes of the table."""
    rows = table[table.is_critical]
    return float(np.interp(acceleration, rows.acceleration, rows.z0, left=NONE, right=NONE))


def largest_critical_height(*, euler: pd.DataFrame, converged: pd.DataFrame, heights: pd.DataFrame) -> Finding:
    """Largest critical height (mm) at the amplitudes of Fig. 9, and at how many the first state occurs above it."""
    amplitudes = np.sort(heights.acceleration.unique())
    values = by_method(
        lambda table: pd.Series([MM * critical_at(table, x) for x in amplitudes], amplitudes), euler, converged
    )
    returns = by_method(
        lambda table: table[table.acceleration.isin(amplitudes) & (table.state_above == "first")], euler, converged
    )
    where = values["converged"].idxmax() if values["converged"].notna().any() else NONE
    note = (
        f"The largest height occurs at {format_amplitude(where)}, where the critical height depends strongly on the "
        "amplitude"
    )
    critical = converged[converged.is_critical]
    if len(critical):
        top = critical.loc[critical.z0.idxmax()]
        repeated = converged[converged.crossing > 1].acceleration.nunique()
        note += (
            f". At {top.acceleration:g} m/s², the lowest amplitude with a second state, it is {MM * top.z0:.4g} mm "
            f"(converged). The state changes more than once over z0 at {repeated} of "
            f"{converged.acceleration.nunique()} amplitudes"
        )
    for row in returns["converged"].itertuples():
        note += f". At {row.acceleration:g} m/s², the first state returns above {MM * row.z0:.3g} mm"
    quantities = (
        {"largest_height": values[method].max(), "returns": float(returns[method].acceleration.nunique())}
        for method in values
    )
    return Finding(*quantities, note)


def critical_height(*, euler: pd.DataFrame, converged: pd.DataFrame, acceleration: float) -> Finding:
    """The critical height (mm) at one amplitude (m/s²)."""
    return single_quantity("height", lambda table: MM * critical_at(table, acceleration), euler, converged)


def velocities(table: pd.DataFrame, state: str) -> tuple[float, float]:
    """Median velocity (cm/s) of one state at both ends of the interval of amplitudes with both states."""
    low, high = two_states(table)
    rows = table[table.state == state]
    return tuple(100.0 * float(rows[rows.acceleration == end].mean_velocity.median()) for end in (low, high))


def relative_miss(values: pd.Series, low: float, high: float) -> pd.Series:
    """By how much values miss an interval, over the nearer end; 0 inside."""
    return np.maximum(np.maximum(low - values, 0.0) / low, np.maximum(values - high, 0.0) / high)


def describe_frictions(
    frictions: pd.DataFrame, heights: pd.DataFrame, velocities_of: dict[str, list[float | None]]
) -> str:
    """At which frictions each of the paper's velocities comes out, and at which all of them do, in words.

    frictions : runs in both states at the ends of the interval of two states, with an axis of frictions
    heights : the runs of Fig. 9, whose amplitudes have the same ends
    velocities_of : accepted intervals (cm/s): velocity of the first state at both ends, fall of the second state
    """
    ends = sorted({heights.acceleration.min(), heights.acceleration.max()})
    at_ends = frictions[frictions.acceleration.isin(ends)]
    if at_ends.empty:
        return f"No other friction was tried at {' and '.join(map(format_amplitude, ends))}"
    rows = {
        friction: velocities(group, "first") + velocities(group, "second")
        for friction, group in at_ends.groupby("friction")
    }
    table = pd.DataFrame(rows, index=["lower", "upper", "second_lower", "second_upper"]).T
    numbers = {"lower_end": table.lower, "upper_end": table.upper, "fall": table.second_lower - table.second_upper}
    fits = {name: values.between(*velocities_of[name], inclusive="both") for name, values in numbers.items()}
    names = {
        "lower_end": "the first state's velocity at the lower end",
        "upper_end": "at the upper end",
        "fall": "the second state's fall",
    }
    texts = [
        f"{names[name]} at frictions of {fit.index[fit].min():g} to {fit.index[fit].max():g}"
        if fit.any()
        else f"{names[name]} at none"
        for name, fit in fits.items()
    ]
    every = fits["lower_end"] & fits["upper_end"] & fits["fall"]
    if every.any():
        together = f"All come out at {every.index[every].min():g} to {every.index[every].max():g}"
    else:
        together = "No friction gives all of them"
        misses = pd.DataFrame({name: relative_miss(values, *velocities_of[name]) for name, values in numbers.items()})
        worst = misses.max(axis=1, skipna=False).dropna()
        if len(worst):
            together += (
                f". At {worst.idxmin():g} they come nearest: each lies within its accepted interval or misses it by at "
                f"most {100.0 * worst.min():.1f} % of its end"
            )
    return (
        f"With another friction, from {table.index.min():g} to {table.index.max():g}, these numbers of the paper come "
        f"out: {', '.join(texts)}. {together}"
    )


def first_velocity(
    *,
    euler: pd.DataFrame,
    converged: pd.DataFrame,
    tension: pd.DataFrame,
    frictions: pd.DataFrame,
    velocities_of: dict[str, list[float | None]],
) -> Finding:
    """Velocity (cm/s) of the first state at both ends of the interval with two states."""
    ends = by_method(lambda table: velocities(table, "first"), euler, converged)
    described = describe_tensions(
        tension, lambda rows: f"{100.0 * rows[rows.state == 'first'].mean_velocity.max():.2f} cm/s"
    )
    low, high = ends["converged"]
    deviation = 100.0 * (ends["euler"][1] / high - 1.0)
    note = (
        f"The velocity rises by {high - low:.2f} cm/s. The paper's method deviates by {deviation:+.1f} % at the upper "
        f"end. The largest velocity at any amplitude, for each treatment of a tensile contact force: {described}. "
        f"{describe_frictions(frictions, converged, velocities_of)}"
    )
    quantities = ({"velocity_at_lower_end": lower, "velocity_at_upper_end": upper} for lower, upper in ends.values())
    return Finding(*quantities, note)


def second_velocity(
    *,
    euler: pd.DataFrame,
    converged: pd.DataFrame,
    fine: pd.DataFrame,
    tension: pd.DataFrame,
    frictions: pd.DataFrame,
    velocities_of: dict[str, list[float | None]],
) -> Finding:
    """Decrease (cm/s) of the velocity of the second state over the interval with two states.

    fine : converged runs at more amplitudes, from which the note takes the minimum
    """
    ends = by_method(lambda table: velocities(table, "second"), euler, converged)
    medians = 100.0 * fine[fine.state == "second"].groupby("acceleration").mean_velocity.median()
    described = describe_tensions(tension, lambda rows: "{:.2f} to {:.2f} cm/s".format(*velocities(rows, "second")))
    within = medians.loc[slice(*two_states(converged))]
    largest = (within.cummax() - within).max()
    low, high = velocities_of["fall"]
    remark = ", which would be accepted: the verdict depends on the reading" if low <= largest <= high else ""
    minimum = (
        f"Its minimum, {within.min():.3f} cm/s, is at {within.idxmin():g} m/s²; the largest fall within the interval "
        f"is {largest:.4g} cm/s{remark}. "
        if len(within)
        else ""
    )
    note = (
        f"Between the ends, the velocity falls from {ends['converged'][0]:.2f} to {ends['converged'][1]:.2f} cm/s. "
        f"{minimum}For each treatment of a tensile contact force, over its own interval: {described}. "
        f"{describe_frictions(frictions, converged, velocities_of)}"
    )
    return Finding(*({"fall": lower - upper} for lower, upper in ends.values()), note)


def flat_part(fit: pd.DataFrame) -> pd.DataFrame:
    """The fits of the valley whose error on the same heights is at most the error of the paper's triple."""
    paper = fit[fit.fit == "paper"].iloc[0]
    return fit[(fit.fit == "valley") & (fit.error <= paper.error)]


def fit(*, euler: pd.DataFrame, converged: pd.DataFrame, regression: pd.DataFrame) -> Finding:
    """Mean squared error (m²) of Eq. 13 with the paper's coefficients, at the amplitudes that both methods have.

    euler, converged : critical heights
    regression : fits of Eq. 13 to the converged heights
    """
    best, paper = (regression.set_index("fit").loc[name, ["A", "B", "C"]].astype(float) for name in ("pymoo", "paper"))
    low, high = regression.attrs["acceleration"]
    edges = by_method(lambda table: table[table.is_critical & table.acceleration.between(low, high)], euler, converged)
    every = edges["converged"]
    shared = {
        method: edge[edge.acceleration.isin(edges[other].acceleration)]
        for (method, edge), other in zip(edges.items(), reversed(edges), strict=True)
    }

    def error(edge: pd.DataFrame) -> float:
        data = edge.acceleration.to_numpy(), edge.z0.to_numpy()
        return float(hyperbola.mean_squared_error(*data, paper)) if len(edge) else NONE

    distances = (hyperbola.critical_height(every.acceleration, paper) - every.z0).abs()
    where = every.acceleration[distances.idxmax()]
    valley = flat_part(regression)
    note = (
        f"Both errors are means over the {len(shared['converged'])} amplitudes at which both methods have a critical "
        "height. The paper's axis is unknown, and the verdict can depend on it: over all "
        f"{len(every)} amplitudes of the converged heights, the error is {error(every):.2e} m². The curve with "
        "the paper's coefficients misses the converged heights by at most "
        f"{1e3 * MM * distances.max():.0f} µm (at {where:g} m/s²; median {1e3 * MM * distances.median():.0f} µm). The "
        f"coefficients themselves are poorly determined: the best ones are A = {best.A:.4g} m²/s², "
        f"B = {best.B:.4g} m/s² and C = {best.C:.4g} m, and every B from {valley.B.min():.4g} to "
        f"{valley.B.max():.4g} m/s² with its best A and C fits no worse than the paper's"
    )
    return Finding(*({"paper_error": error(edge)} for edge in shared.values()), note)


def find_runs(x: ArrayLike, chosen: ArrayLike) -> list[tuple[float, float]]:
    """First and last x of each run of consecutive chosen values; x is ascending."""
    x = np.asarray(x)
    edges = np.flatnonzero(np.diff(np.pad(np.asarray(chosen, dtype=bool), 1)))
    return [(float(x[begin]), float(x[end - 1])) for begin, end in zip(edges[::2], edges[1::2], strict=True)]


def format_runs(runs: list[tuple[float, float]], limit: int = 4) -> str:
    """The longest runs of amplitudes (m/s²) in ascending order, and the number of all shorter ones, in words."""
    longest = sorted(sorted(runs, key=lambda run: run[0] - run[1])[:limit])
    text = ", ".join(f"{low:.2f}" if low == high else f"{low:.2f} to {high:.2f}" for low, high in longest) + " m/s²"
    return text if len(runs) <= limit else f"{text} and {len(runs) - limit} shorter ones"


def one_onset(*, converged: pd.DataFrame, on_plate: pd.DataFrame) -> Finding:
    """Distances (m/s²) between the lowest and the highest onset of all initial heights, and between their first chaos.

    The onset is the amplitude with the fewest exceptions, the first chaos the lowest amplitude with chaos at all.

    There is no number by the paper's method, because the converged solution determines the states of both methods.
    """
    heights = converged.groupby("z0")
    onsets = np.array([onset(rows.acceleration, rows.state == "chaos") for _, rows in heights])
    first = np.array([rows.acceleration[rows.state == "chaos"].min() for _, rows in heights])
    share = (converged.state == "chaos").groupby(converged.acceleration).mean()
    coexisting = find_runs(share.index, (share > 0.0) & (share < 1.0))
    note = "An onset is the amplitude with the fewest exceptions, which are chaos below it and none above it. "
    lower = onset(on_plate.acceleration, on_plate.state == "chaos")
    note += (
        f"The onsets lie between {format_amplitude(onsets.min())} and {format_amplitude(onsets.max())}, for initial "
        f"heights from {MM * converged.z0.min():g} to {MM * converged.z0.max():g} mm. For a part that starts on the "
        f"plate, and so lower, the onset is {format_amplitude(lower)}"
    )
    early = first < onsets.min()
    if early.any():
        note += (
            f". For {100 * early.mean():.0f} % of the heights, chaos occurs before all onsets, from "
            f"{format_amplitude(first.min())} on"
        )
    if coexisting:
        note += f". Chaos and regular motion coexist, depending on the initial height, at {format_runs(coexisting)}"
    if (share < 1.0).any():
        windows = find_runs(share.index, (share < 1.0) & (share.index > onsets.max()))
        note += ". Above the onset, regular motion remains " + (
            f"in windows only: {format_runs(windows)}" if windows else "nowhere"
        )
        note += f", on an axis in steps of {amplitude_step(converged):.3f} m/s²"
    return Finding({}, {"spread": float(np.ptp(onsets)), "first_spread": float(np.ptp(first))}, note)


def impact_line(*, converged: pd.DataFrame) -> Finding:
    """Slope (rad s/m) of the impact phase over the impact velocity, and the largest distance from the line (rad)."""
    rows = converged.dropna(subset="impact_velocity")
    slope, base, _ = fit_line(rows.impact_velocity.to_numpy(), rows.impact_phase.to_numpy())
    distance = np.abs(slope * rows.impact_velocity + base - rows.impact_phase).max()
    return Finding({}, {"slope": float(slope), "distance": float(distance)})


def count_lines(table: pd.DataFrame, signal: str, threshold: float = LINE) -> tuple[int, int, float]:
    """Numbers of lines above zero frequency in the first and the second state; mean over largest line in the second.

    Lines smaller than `threshold` times the largest amplitude of their spectrum do not count.
    """
    spectra = [rows for _, rows in table[table.signal == signal].groupby("acceleration")]
    counts = [int((rows[rows.frequency > 0.0].amplitude > threshold * rows.amplitude.max()).sum()) for rows in spectra]
    second = spectra[-1]
    ratio = second[second.frequency == 0.0].amplitude.max() / second[second.frequency > 0.0].amplitude.max()
    return counts[0], counts[-1], float(ratio)


def vertical_lines(*, euler: pd.DataFrame, converged: pd.DataFrame) -> Finding:
    """Lines that the vertical velocity has more in the second state than in the first."""

    def count_difference(table):
        first, second, _ = count_lines(table, "vz")
        return second - first

    return single_quantity("more_lines", count_difference, euler, converged)


def horizontal_lines(*, euler: pd.DataFrame, converged: pd.DataFrame) -> Finding:
    """Lines that the feeding velocity has more in the first state; mean over largest line in the second."""
    values = by_method(lambda table: count_lines(table, "vx"), euler, converged)
    first, second, _ = count_lines(converged, "vx", LINE / 4.0)
    note = (
        f"Lines of less than {100.0 * LINE:g} % of the largest amplitude, which is the mean in the second state, do "
        f"not count. The first part of the statement depends on this limit: with {25.0 * LINE:g} %, the first state "
        f"has {first} lines and the second {second}. The lines of the second state are small beside its mean only"
    )
    quantities = (
        {"more_lines": float(first - second), "mean_over_line": ratio} for first, second, ratio in values.values()
    )
    return Finding(*quantities, note)


def overlap(
    *, height_low: pd.DataFrame, height_high: pd.DataFrame, velocity_low: pd.DataFrame, velocity_high: pd.DataFrame
) -> Finding:
    """Share of the points without chaos at the higher amplitude that have the same state at the lower one."""
    shares = {}
    common = {"first": [], "second": []}
    maps = {"height": (height_low, height_high), "velocity": (velocity_low, velocity_high)}
    for place, (lower, higher) in maps.items():
        low, high = lower.state.to_numpy(), higher.state.to_numpy()
        regular = high != "chaos"
        shares[f"shared_{place}"] = float((low[regular] == high[regular]).mean()) if regular.any() else NONE
        shares[f"chaos_{place}"] = float((high == "chaos").mean())
        for state, percentages in common.items():
            percentages.append(100.0 * float((low[high == state] == state).mean()) if (high == state).any() else NONE)
    chaotic = sum(int((table.state == "chaos").sum()) for table in (height_low, velocity_low))
    note = (
        "Of the points in one state at the higher amplitude, as many are in the same state at the lower one: first "
        f"state {common['first'][0]:.1f} % (Fig. 18) and {common['first'][1]:.1f} % (Fig. 19), second state "
        f"{common['second'][0]:.1f} % and {common['second'][1]:.1f} %. At the lower amplitude, {chaotic} points of "
        "both maps are chaotic"
    )
    return Finding({}, shares, note)


def mapped(*, converged: pd.DataFrame) -> Finding:
    """Share of the initial conditions in the air that lead to the same state as their first impact on the plate."""
    rows = converged.dropna(subset="mapped_state")
    return Finding({}, {"equal": float((rows.state == rows.mapped_state).mean()) if len(rows) else NONE})


def euler_error(
    *,
    euler: pd.DataFrame,
    converged: pd.DataFrame,
    euler_exponent: pd.DataFrame,
    converged_exponent: pd.DataFrame,
    states: pd.DataFrame,
) -> Finding:
    """Median relative errors of Euler's mean velocity in both states, and share of its exponents with the right sign.

    Velocities are compared where both methods lead to the same state with the period of the excitation. The exponents
    are the estimates of Fig. 22; their right sign is that of the converged estimate. The note reads them as the paper
    does: a positive one means that the motion is chaotic.
    """
    regular = ((converged.period == 1) & (euler.period == 1) & (converged.state == euler.state)).to_numpy()
    signed = (euler.mean_velocity / converged.mean_velocity - 1.0)[regular]
    errors = signed.abs().groupby(converged.state[regular]).median().reindex(["first", "second"])
    signs = (
        table.set_index("acceleration")["lambda"].sort_index() > 0.0 for table in (euler_exponent, converged_exponent)
    )
    estimates = [with_settled_motion(table, states) for table in (euler_exponent, converged_exponent)]
    known = [table[table.chaotic | (table.period > 0)] for table in estimates]
    wrong = [table[(table["lambda"] > 0.0) != table.chaotic].acceleration for table in known]
    middle = ""
    if len(wrong[0]):
        middle = f", half of them between {wrong[0].quantile(0.25):.1f} and {wrong[0].quantile(0.75):.1f} m/s²,"
    note = (
        f"Explicit Euler underestimates the mean velocity in {(signed < 0.0).sum()} of {len(signed)} runs of period 1. "
        "Read as in the paper, where a positive estimate means chaos, the estimate is wrong at "
        f"{len(wrong[0])} of {len(known[0])} amplitudes by the paper's method"
        f"{middle} and at {len(wrong[1])} by the converged solution"
    )
    quantities = {"first_error": float(errors["first"]), "second_error": float(errors["second"])}
    return Finding(quantities | {"equal_signs": float(operator.eq(*signs).mean())}, {}, note)
