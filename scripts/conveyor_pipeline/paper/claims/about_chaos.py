"""Sect. 4 of the paper: chaotic motion, Lyapunov exponents, phase portraits and their dimensions."""

import numpy as np
import pandas as pd

from conveyor_pipeline.paper.claims import about_proofs
from conveyor_pipeline.paper.claims.finding import METHODS, Finding, by_method, format_amplitude, onset, single_quantity

LONGEST_PERIOD = 64  # excitation cycles
CLOSE = 0.05  # largest distance from an earlier state, relative to the largest one, that counts as a return


def closest_return(run: pd.DataFrame) -> tuple[float, int]:
    """The least distance between a motion, sampled once per excitation cycle, and itself one period (cycles) before.

    The distance of a period is the largest one over the last LONGEST_PERIOD samples, in units of the largest position
    and velocity. The period is the one with the least distance.
    """
    states = run.sort_values("time", kind="stable")[["z", "vz"]].to_numpy()
    states = states / np.abs(states).max(axis=0)
    last = np.arange(len(states) - LONGEST_PERIOD, len(states))
    distances = [float(np.abs(states[last] - states[last - period]).max()) for period in range(1, LONGEST_PERIOD + 1)]
    return min(distances), int(np.argmin(distances)) + 1


def no_period(*, euler: pd.DataFrame, converged: pd.DataFrame, horseshoes: pd.DataFrame) -> Finding:
    """Share of the initial heights whose motion has no period of up to 64 cycles at the end of a long run."""

    def find_returns(table: pd.DataFrame) -> list[tuple[float, int]]:
        return [closest_return(run) for _, run in table.groupby("z0")]

    returns = by_method(find_returns, euler, converged)
    closest = {method: min(distances) for method, distances in returns.items()}
    note = (
        f"No motion repeats itself with a period of up to {LONGEST_PERIOD} cycles. The best period misses by "
        + " and ".join(
            f"{100 * distance:.0f} % of the largest height or velocity ({period} cycles, by the {METHODS[method]})"
            for method, (distance, period) in closest.items()
        )
    )
    shares = (
        {"share": float(np.mean([distance > CLOSE for distance, _ in distances]))} for distances in returns.values()
    )
    return Finding(*shares, note + about_proofs.describe_chaos(horseshoes))


def irregular(*, euler: pd.DataFrame, converged: pd.DataFrame) -> Finding:
    """Median step of the velocity from one initial height to the next over its standard deviation."""

    def step(table):
        velocity = table.sort_values("z0").mean_velocity.to_numpy()
        return np.median(np.abs(np.diff(velocity))) / np.std(velocity)

    return single_quantity("step", step, euler, converged)


def height_estimate(*, euler: pd.DataFrame, converged: pd.DataFrame) -> Finding:
    """Lowest amplitude (m/s²) with a positive estimate, and changes of its sign between 50 and 60 m/s²."""
    quantities = []
    for table in (euler, converged):
        between = table[table.acceleration.between(50.0, 60.0)]
        changes = float((np.diff(np.sign(between["lambda"])) != 0.0).sum())
        quantities.append({"lowest_positive": table[table["lambda"] > 0.0].acceleration.min(), "changes": changes})
    return Finding(*quantities)


def size_of_perturbation(
    *, euler: pd.DataFrame, converged: pd.DataFrame, large: pd.DataFrame, large_euler: pd.DataFrame, acceleration: float
) -> Finding:
    """Numbers of amplitudes below one (m/s²) with a positive exponent, from a large and a small difference in z0."""

    def count(table: pd.DataFrame) -> float:
        return float(((table["lambda"] > 0.0) & (table.acceleration < acceleration)).sum())

    quantities = (
        {"with_large": count(large_table), "with_small": count(small_table)}
        for large_table, small_table in ((large_euler, euler), (large, converged))
    )
    note = (
        f"The large difference is {large.attrs['epsilon']:g} m, the small one {converged.attrs['epsilon']:g} m. Both "
        "are differences in z0, so that the size alone explains the positive exponents below the onset of chaos. The "
        "paper's second reason, that z0 is not independent, is not needed"
    )
    return Finding(*quantities, note)


def positive_onset(table: pd.DataFrame) -> float:
    """Amplitude (m/s²) from which the estimated exponent is positive."""
    return onset(table.acceleration, table["lambda"] > 0.0)


def join_nearest(table: pd.DataFrame, others: pd.DataFrame) -> pd.DataFrame:
    """The rows by amplitude, each with the columns of the row of `others` at the nearest amplitude."""
    tables = (one.sort_values("acceleration", kind="stable") for one in (table, others))
    return pd.merge_asof(*tables, on="acceleration", direction="nearest")


def with_settled_motion(table: pd.DataFrame, states: pd.DataFrame) -> pd.DataFrame:
    """The rows with the state and the period of the motion to which each trajectory settles, and whether it is chaos.

    states : settled motions over the amplitude, of the same initial condition; those of the nearest amplitude are taken
    """
    rows = join_nearest(table, states[["acceleration", "state", "period"]])
    return rows.assign(chaotic=rows.state == "chaos")


def phase_estimate(
    *,
    euler: pd.DataFrame,
    converged: pd.DataFrame,
    states: pd.DataFrame,
    estimates: pd.DataFrame,
    moved: pd.DataFrame,
    certificates: pd.DataFrame,
) -> Finding:
    """Amplitude (m/s²) from which the estimate of Fig. 22 is positive."""
    begin, end = by_method(positive_onset, euler, converged).values()

    def between(table: pd.DataFrame) -> pd.DataFrame:
        return table[table.acceleration.between(begin, end, inclusive="left")]

    settled = with_settled_motion(converged, states)
    exponents = by_method(lambda table: between(table)["lambda"], euler, converged)
    texts = [
        f"{100 * (values > 0.0).mean():.0f} % of the amplitudes by the {METHODS[method]} (median "
        f"{values.median():+.2f} 1/s)"
        for method, values in exponents.items()
    ]
    note = (
        f"Between {format_amplitude(begin)} and {format_amplitude(end)}, the estimate is positive at {texts[0]} and at "
        f"{texts[1]}. There, {100 * (between(settled).period > 0).mean():.0f} % of these trajectories settle to a "
        "periodic motion. The lowest amplitude at which one stays chaotic is "
        f"{format_amplitude(settled[settled.chaotic].acceleration.min())}. {describe_perturbations(estimates)}. "
        f"{describe_moved_impacts(moved)}. Trajectories begin with ż0 = 0, which the paper leaves open; the onset of "
        "positive estimates by its method can depend on this choice"
    )
    return Finding({"amplitude": begin}, {"amplitude": end}, note + about_proofs.describe_periodic(certificates, begin))


def describe_perturbations(estimates: pd.DataFrame) -> str:
    """How the estimate for a periodic motion depends on the perturbation, in words."""
    # Not at the top, because captions import this module, and Numba takes most of their time.
    from conveyor_pipeline.paper.orbits.stability_estimates import CASES

    rows = estimates[(estimates.panel == "perturbation") & (estimates.case == "orbit_phase")]
    by_euler, converged = (rows[rows.estimator == method].value for method in ("euler", "event"))
    acceleration = CASES["orbit_phase"]["acceleration"]
    return (
        f"At {acceleration:g} m/s², where the motion is periodic, perturbations from {rows.epsilon.min():g} to "
        f"{rows.epsilon.max():g} rad give {by_euler.min():+.2f} to {by_euler.max():+.2f} 1/s by the paper's method and "
        f"{converged.min():+.2f} to {converged.max():+.2f} 1/s by the converged solution"
    )


def describe_moved_impacts(moved: pd.DataFrame) -> str:
    """By how much the perturbation of Fig. 22 moves the impacts by both methods, in words."""
    ends = moved[(moved.time == moved.time.max()) & (moved.epsilon == moved.epsilon.min())]
    by_euler, converged = (ends[ends.method == method] for method in ("euler", "event"))
    return (
        f"A perturbation of {ends.epsilon.min():g} rad shifts the exact motion in time by {ends.time_shift.min():.1g} "
        f"s, and the impacts of the converged solution move by {converged.mean_shift.mean():.3f} of it. By the paper's "
        f"method, {by_euler.moved.sum()} of {by_euler.impacts.sum()} impacts move. On a periodic motion such a shift "
        "neither grows nor decays, so that the exponent is zero; only whether the estimate is positive is judged, "
        "which the paper reads as chaos. At a finite time, this depends on the units, m/s and rad"
    )


def portraits(*, euler: pd.DataFrame, converged: pd.DataFrame) -> Finding:
    """Dimensions of the phase portraits in the first state, the second state and chaos."""

    def dimensions(table: pd.DataFrame) -> dict[str, float]:
        table = table.sort_values(["acceleration", "z0"])
        low, high = (table[table.acceleration == end] for end in (table.acceleration.min(), table.acceleration.max()))
        values = (*map(float, low.dimension), float(high.dimension.iloc[0]))
        return dict(zip(("first", "second", "chaos"), values, strict=True))

    of_methods = by_method(dimensions, euler, converged)
    texts = {method: ", ".join(f"{value:.3f}" for value in values.values()) for method, values in of_methods.items()}
    note = (
        f"The converged dimensions are {texts['converged']}, with 95 % intervals of at most "
        f"±{converged.error.max():.2f}. Box counting as in the paper includes the transient and uses too few scales; "
        f"it gives {texts['euler']}"
    )
    return Finding(of_methods["euler"], of_methods["converged"], note)


def known_dimensions(table: pd.DataFrame) -> pd.DataFrame:
    """The rows with a dimension, in the order of the amplitude."""
    return table.dropna(subset="dimension").sort_values("acceleration", kind="stable")


def dimension_onset(table: pd.DataFrame) -> float:
    """Amplitude (m/s²) from which the dimension is closer to its values at the upper end than at the lower end."""
    rows = known_dimensions(table)
    tenth = max(1, len(rows) // 10)
    middle = 0.5 * (rows.dimension.head(tenth).median() + rows.dimension.tail(tenth).median())
    return onset(rows.acceleration, rows.dimension > middle)


def from_lowest_height(states: pd.DataFrame) -> pd.DataFrame:
    """The motions from the lowest initial height, in the order of the amplitude."""
    return states[states.z0 == states.z0.min()].sort_values("acceleration", kind="stable")


def predicted_onset(
    *,
    euler: pd.DataFrame,
    converged: pd.DataFrame,
    euler_exponent: pd.DataFrame,
    converged_exponent: pd.DataFrame,
    states: pd.DataFrame,
    states_of_exponent: pd.DataFrame,
) -> Finding:
    """Distances (m/s²) of the onsets by dimension and by the exponent of Fig. 22 from chaos.

    Each onset is compared with the onset of chaos for its own initial condition.
    """
    states = from_lowest_height(states)
    chaos, chaos_on_plate = (
        onset(table.acceleration, table.state == "chaos") for table in (states, states_of_exponent)
    )
    quantities = (
        {"dimension": abs(dimension_onset(table) - chaos), "exponent": abs(positive_onset(exponent) - chaos_on_plate)}
        for table, exponent in ((euler, euler_exponent), (converged, converged_exponent))
    )
    unknown = converged[converged.dimension.isna()].status.value_counts()
    note = (
        "An onset is the amplitude with the fewest exceptions, which are chaos below it and none above it. The initial "
        "conditions are open. Fig. 24 has the one of Fig. 3 here: for the one of Fig. 22, on the plate, the dimension "
        "by the paper's method would not rise where it does in the paper. Chaos begins at "
        f"{format_amplitude(chaos)} for the one of Fig. 24, and at {format_amplitude(chaos_on_plate)} for the one of "
        "Fig. 22. The converged dimension shows "
        f"{format_amplitude(dimension_onset(converged))}, and the converged estimate of Fig. 22 "
        f"{format_amplitude(positive_onset(converged_exponent))}. By the paper's method, they show "
        f"{format_amplitude(dimension_onset(euler))} and {format_amplitude(positive_onset(euler_exponent))}: its box "
        f"counting gives {dimension_range(euler, states, 'second')} in the second state and "
        f"{dimension_range(euler, states, 'chaos')} in chaos. Converged phase portraits have no known dimension at "
        f"{unknown.sum()} of {len(converged)} amplitudes{describe_counts(unknown)}"
    )
    return Finding(*quantities, note)


def fluctuation(*, euler: pd.DataFrame, converged: pd.DataFrame, states: pd.DataFrame) -> Finding:
    """The largest change of the dimension between neighbouring amplitudes at which both motions are chaotic."""
    states = from_lowest_height(states)

    def largest_steps(table: pd.DataFrame) -> tuple[float, float]:
        """The largest change within chaos, and at its edges; NaN where a neighbour has no estimate."""
        rows = with_settled_motion(table, states)
        steps = rows.dimension.diff().abs()
        before = rows.chaotic.shift(fill_value=False)
        return steps[rows.chaotic & before].max(), steps[rows.chaotic != before].max()

    steps = by_method(largest_steps, euler, converged)
    note = (
        f"Within chaos, the converged dimension changes by at most {steps['converged'][0]:.3f} between neighbouring "
        f"amplitudes, and the dimension by the paper's method by {steps['euler'][0]:.2f}. At the edges of chaos, "
        f"the converged dimension changes by up to {steps['converged'][1]:.2f}"
    )
    return Finding(*({"largest_step": float(within)} for within, _ in steps.values()), note)


def describe_counts(counts: pd.Series) -> str:
    """The reasons and how often each occurs, in parentheses; empty for none."""
    return f" ({', '.join(f'{reason}: {count}' for reason, count in counts.items())})" if len(counts) else ""


def dimension_range(euler: pd.DataFrame, states: pd.DataFrame, state: str) -> str:
    """Least and largest dimension, by box counting as in the paper, of the motions that settle to a state."""
    rows = with_settled_motion(euler, states)
    dimensions = rows[rows.state == state].dimension
    return f"{dimensions.min():.2f} to {dimensions.max():.2f}"
