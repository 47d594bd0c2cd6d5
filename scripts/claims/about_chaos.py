"""Sect. 4 of the paper: chaotic motion, Lyapunov exponents, phase portraits and their dimensions."""

import numpy as np
import pandas as pd

from claims import about_proofs
from claims.finding import METHODS, NONE, Finding, by_both, by_method, format_value, lowest, onset

LONGEST_PERIOD = 64  # excitation cycles
BACK = 0.05  # of the largest position or velocity: nearer than that, a motion has come back
NAMES = {"euler": "by the paper's method", "converged": "converged"}


def least_return(run: pd.DataFrame) -> tuple[float, int]:
    """How near a motion, seen once in an excitation cycle, comes back again and again, and after how many cycles.

    The distance is the largest one of the last LONGEST_PERIOD samples from those one period before, in units of the
    largest position and velocity; the period is that with the least distance.
    """
    seen = run.sort_values("time")[["z", "vz"]].to_numpy()
    seen = seen / np.abs(seen).max(axis=0)
    last = np.arange(len(seen) - LONGEST_PERIOD, len(seen))
    distances = [float(np.abs(seen[last] - seen[last - period]).max()) for period in range(1, LONGEST_PERIOD + 1)]
    return min(distances), int(np.argmin(distances)) + 1


def no_period(*, euler: pd.DataFrame, converged: pd.DataFrame, horseshoes: pd.DataFrame | None = None) -> Finding:
    """Share of the starts whose motion has no period of up to 64 cycles at the end of a long run."""

    def all_returns(table: pd.DataFrame) -> list[tuple[float, int]]:
        return [least_return(run) for _, run in table.groupby("z0")]

    returns = by_method(all_returns, euler, converged)
    nearest = {method: min(found) for method, found in returns.items()}
    note = "the motions come back no nearer than " + " and ".join(
        f"{100 * distance:.2g} % of their extent, after {period} cycles ({NAMES[method]})"
        for method, (distance, period) in nearest.items()
    )
    shares = ({"share": float(np.mean([distance > BACK for distance, _ in found]))} for found in returns.values())
    return Finding(*shares, note + about_proofs.chaotic(horseshoes))


def irregular(*, euler: pd.DataFrame, converged: pd.DataFrame) -> Finding:
    """Median step of the velocity from one initial height to the next over its standard deviation."""

    def step(table):
        velocity = table.sort_values("z0").mean_velocity.to_numpy()
        return np.median(np.abs(np.diff(velocity))) / np.std(velocity)

    return by_both("step", step, euler, converged)


def height_estimate(*, euler: pd.DataFrame, converged: pd.DataFrame) -> Finding:
    """Lowest amplitude (m/s²) with a positive estimate, and changes of its sign between 50 and 60 m/s²."""
    found = []
    for table in (euler, converged):
        between = table[(table.acceleration >= 50.0) & (table.acceleration <= 60.0)]
        changes = float((np.diff(np.sign(between["lambda"])) != 0.0).sum())
        found.append({"lowest_positive": lowest(table[table["lambda"] > 0.0].acceleration), "changes": changes})
    return Finding(*found)


def positive_onset(table: pd.DataFrame) -> float:
    return onset(table.acceleration.to_numpy(), (table["lambda"] > 0.0).to_numpy())


def phase_estimate(
    *,
    euler: pd.DataFrame,
    converged: pd.DataFrame,
    states: pd.DataFrame,
    estimates: pd.DataFrame,
    certificates: pd.DataFrame | None = None,
) -> Finding:
    found = by_method(positive_onset, euler, converged)
    settled = states[(states.acceleration >= found["euler"]) & (states.acceleration < found["converged"])]
    settled = settled[settled.z0 == settled.z0.min()]
    between = {
        method: table[(table.acceleration >= found["euler"]) & (table.acceleration < found["converged"])]["lambda"]
        for method, table in (("euler", euler), ("converged", converged))
    }
    texts = [
        f"{100 * (values > 0.0).mean():.0f} % of the amplitudes {NAMES[method]} (median {values.median():+.2f} 1/s)"
        for method, values in between.items()
    ]
    note = (
        f"between {format_value(found['euler'])} and {format_value(found['converged'])} the estimate is positive at "
        f"{texts[0]} and at {texts[1]}, and {100 * (settled.period > 0).mean():.0f} % settle to a period; "
        f"{of_perturbations(estimates)}"
    )
    proved = about_proofs.regular(certificates, found["euler"])
    return Finding(*({"amplitude": found[method]} for method in METHODS), note + proved)


def of_perturbations(estimates: pd.DataFrame) -> str:
    """How the estimate in a regular motion depends on the perturbation."""
    rows = estimates[(estimates.panel == "perturbation") & (estimates.case == "orbit_phase")]
    by_euler, converged = (rows[rows.estimator == method].value for method in ("euler", "event"))
    acceleration = estimates.attrs["exponent"]["cases"]["orbit_phase"]["acceleration"]
    return (
        f"at {acceleration:g} m/s², a settled motion, perturbations from {rows.epsilon.min():g} to "
        f"{rows.epsilon.max():g} rad give {by_euler.min():+.2f} to {by_euler.max():+.2f} 1/s by the paper's method and "
        f"{converged.min():+.2f} to {converged.max():+.2f} 1/s converged"
    )


def portraits(*, euler: pd.DataFrame, converged: pd.DataFrame) -> Finding:
    """Dimensions of the portraits in the first state, the second state and chaos."""

    def dimensions(table: pd.DataFrame) -> dict[str, float]:
        table = table.sort_values(["acceleration", "z0"])
        low, high = (table[table.acceleration == end] for end in (table.acceleration.min(), table.acceleration.max()))
        values = (*map(float, low.dimension), float(high.dimension.iloc[0]))
        return dict(zip(("first", "second", "chaos"), values, strict=True))

    found = by_method(dimensions, euler, converged)
    texts = {method: ", ".join(f"{value:.3f}" for value in values.values()) for method, values in found.items()}
    note = (
        f"converged {texts['converged']} with 95 % intervals of at most ±{converged.error.max():.2f}; boxes counted as "
        f"in the paper take the transient and too few scales: {texts['euler']}"
    )
    return Finding(found["euler"], found["converged"], note)


def known_dimensions(table: pd.DataFrame) -> pd.DataFrame:
    """The rows in which a dimension could be told, by amplitude."""
    return table.dropna(subset="dimension").sort_values("acceleration")


def dimension_onset(table: pd.DataFrame) -> float:
    """Amplitude (m/s²) from which on the dimension is nearer to its values at the upper end than at the lower one."""
    rows = known_dimensions(table)
    tenth = max(1, len(rows) // 10)
    middle = 0.5 * (rows.dimension.head(tenth).median() + rows.dimension.tail(tenth).median())
    return onset(rows.acceleration.to_numpy(), (rows.dimension > middle).to_numpy())


def predicted_onset(
    *,
    euler: pd.DataFrame,
    converged: pd.DataFrame,
    euler_exponent: pd.DataFrame,
    converged_exponent: pd.DataFrame,
    states: pd.DataFrame,
) -> Finding:
    """Distance (m/s²) between the onset by dimension and the onset by the exponent of Fig. 22, and fluctuation: largest
    step of the dimension between neighbouring amplitudes at which it is known.
    """
    found = []
    for table, exponent in ((euler, euler_exponent), (converged, converged_exponent)):
        by_dimension, by_exponent = dimension_onset(table), positive_onset(exponent)
        steps = np.abs(np.diff(known_dimensions(table).dimension))
        found.append(
            {"distance": abs(by_dimension - by_exponent), "largest_step": float(steps.max()) if len(steps) else NONE}
        )
    unknown = converged[converged.dimension.isna()].acceleration
    note = (
        f"by dimension chaos begins at {format_value(dimension_onset(converged))}, by the estimate of Fig. 22 at "
        f"{format_value(positive_onset(converged_exponent))}; by the paper's method at "
        f"{format_value(dimension_onset(euler))} and {format_value(positive_onset(euler_exponent))}, where the "
        f"second state begins: its boxes give {dimension_range(euler, states, 'second')} in that and "
        f"{dimension_range(euler, states, 'chaos')} in chaos; converged portraits have no scaling region at "
        f"{len(unknown)} of {len(converged)} amplitudes"
    )
    return Finding(*found, note)


def dimension_range(euler: pd.DataFrame, states: pd.DataFrame, state: str) -> str:
    """Least and largest dimension by the paper's boxes of the motions that settle to a state, from the same start."""
    states = states[states.z0 == states.z0.min()].sort_values("acceleration")[["acceleration", "state"]]
    rows = pd.merge_asof(euler.sort_values("acceleration"), states, on="acceleration", direction="nearest")
    found = rows[rows.state == state].dimension
    return f"{found.min():.2f} to {found.max():.2f}"
