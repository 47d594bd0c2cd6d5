"""Sect. 4 of the paper: chaotic motion, Lyapunov exponents, phase portraits and their dimensions."""

import numpy as np
import pandas as pd

from findings import proofs
from findings.finding import Finding, lowest, onset

LONGEST_PERIOD = 64  # excitation cycles
BACK = 0.05  # of the largest position or velocity: nearer than that, a motion has come back


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


def no_period(tables: dict[str, pd.DataFrame]) -> Finding:
    """C15: share of the starts whose motion has no period of up to 64 cycles at the end of a long run."""
    returns = {
        role: [least_return(run) for _, run in tables[role].groupby("z0")] for role in ("published", "converged")
    }
    shares = [(float(np.mean([distance > BACK for distance, _ in found])),) for found in returns.values()]
    nearest = {role: min(found) for role, found in returns.items()}
    reason = "the motions come back no nearer than " + " and ".join(
        f"{100 * distance:.2g} % of their extent, after {period} cycles ({method})"
        for method, (distance, period) in (("Euler", nearest["published"]), ("converged", nearest["converged"]))
    )
    return Finding(*shares, reason + proofs.chaotic(tables))


def irregular(tables: dict[str, pd.DataFrame]) -> Finding:
    """C16: median step of the velocity from one initial height to the next over its standard deviation."""
    shares = []
    for role in ("published", "converged"):
        velocity = tables[role].sort_values("z0").mean_velocity.to_numpy()
        shares.append((float(np.median(np.abs(np.diff(velocity))) / np.std(velocity)),))
    return Finding(*shares)


def height_estimate(tables: dict[str, pd.DataFrame]) -> Finding:
    """C18: lowest amplitude (m/s²) with a positive estimate, and changes of its sign between 50 and 60 m/s²."""
    found = []
    for role in ("published", "converged"):
        table = tables[role]
        between = table[(table.acceleration >= 50.0) & (table.acceleration <= 60.0)]
        changes = float((np.diff(np.sign(between["lambda"])) != 0.0).sum())
        found.append((lowest(table[table["lambda"] > 0.0].acceleration), changes))
    return Finding(*found)


def positive_onset(table: pd.DataFrame) -> float:
    return onset(table.acceleration.to_numpy(), (table["lambda"] > 0.0).to_numpy())


def phase_estimate(tables: dict[str, pd.DataFrame]) -> Finding:
    """C19: amplitude (m/s²) above which the estimate is positive."""
    found = {role: positive_onset(tables[role]) for role in ("published", "converged")}
    states = tables["states"]
    settled = states[(states.acceleration >= found["published"]) & (states.acceleration < found["converged"])]
    settled = settled[settled.z0 == settled.z0.min()]
    between = {
        role: table[(table.acceleration >= found["published"]) & (table.acceleration < found["converged"])]["lambda"]
        for role, table in ((role, tables[role]) for role in found)
    }
    texts = [
        f"{100 * (values > 0.0).mean():.0f} % of the amplitudes {method} (median {values.median():+.2f} 1/s)"
        for method, values in (("by Euler", between["published"]), ("converged", between["converged"]))
    ]
    reason = (
        f"between {found['published']:g} and {found['converged']:g} m/s² the estimate is positive at {texts[0]} and at "
        f"{texts[1]}, and {100 * (settled.period > 0).mean():.0f} % settle to a period; {of_perturbations(tables)}"
    )
    return Finding((found["published"],), (found["converged"],), reason + proofs.regular(tables, found["published"]))


def of_perturbations(tables: dict[str, pd.DataFrame]) -> str:
    """How the estimate in a regular motion depends on the perturbation."""
    table = tables["estimates"]
    rows = table[(table.panel == "perturbation") & (table.case == "orbit_phase")]
    by_euler, converged = (rows[rows.estimator == method].value for method in ("euler", "event"))
    acceleration = table.attrs["exponent"]["cases"]["orbit_phase"]["acceleration"]
    return (
        f"at {acceleration:g} m/s², a settled motion, perturbations from {rows.epsilon.min():g} to "
        f"{rows.epsilon.max():g} rad give {by_euler.min():+.2f} to {by_euler.max():+.2f} 1/s by Euler and "
        f"{converged.min():+.2f} to {converged.max():+.2f} 1/s converged"
    )


def portraits(tables: dict[str, pd.DataFrame]) -> Finding:
    """C20: dimensions of the portraits in the first state, the second state and chaos."""
    found = []
    for role in ("published", "converged"):
        table = tables[role].sort_values(["acceleration", "z0"])
        low, high = (table[table.acceleration == end] for end in (table.acceleration.min(), table.acceleration.max()))
        found.append((*map(float, low.dimension), float(high.dimension.iloc[0])))
    errors = tables["converged"].sort_values(["acceleration", "z0"]).error
    reason = (
        f"converged {found[1][0]:.3f}, {found[1][1]:.3f}, {found[1][2]:.3f} with 95 % intervals of at most "
        f"±{errors.max():.2f}; boxes of the published kind count the transient and too few scales: "
        f"{found[0][0]:.2f}, {found[0][1]:.2f}, {found[0][2]:.2f}"
    )
    return Finding(found[0], found[1], reason)


def dimension_onset(table: pd.DataFrame) -> float:
    """Amplitude (m/s²) from which on the dimension is nearer to its values at the upper end than at the lower one."""
    tenth = max(1, len(table) // 10)
    rows = table.sort_values("acceleration")
    middle = 0.5 * (rows.dimension.head(tenth).median() + rows.dimension.tail(tenth).median())
    return onset(rows.acceleration.to_numpy(), (rows.dimension > middle).to_numpy())


def predicted_onset(tables: dict[str, pd.DataFrame]) -> Finding:
    """C21: distance (m/s²) between the onset by dimension and the onset by the exponent of Fig. 22, and fluctuation:
    largest step of the dimension between neighbouring amplitudes.
    """
    found = []
    for role in ("published", "converged"):
        by_dimension, by_exponent = dimension_onset(tables[role]), positive_onset(tables[f"{role}_exponent"])
        step = float(np.abs(np.diff(tables[role].sort_values("acceleration").dimension)).max())
        found.append((abs(by_dimension - by_exponent), step))
    reason = (
        f"by dimension chaos begins at {dimension_onset(tables['converged']):g} m/s², by the estimate of Fig. 22 at "
        f"{positive_onset(tables['converged_exponent']):g} m/s²; by Euler at {dimension_onset(tables['published']):g} "
        f"and {positive_onset(tables['published_exponent']):g} m/s², where the second state begins: its boxes give "
        f"{dimension_range(tables, 'second')} in that and {dimension_range(tables, 'chaos')} in chaos"
    )
    return Finding(found[0], found[1], reason)


def dimension_range(tables: dict[str, pd.DataFrame], state: str) -> str:
    """Least and largest published dimension of the motions that settle to a state, from the same start."""
    states = tables["states"]
    states = states[states.z0 == states.z0.min()].sort_values("acceleration")[["acceleration", "state"]]
    rows = pd.merge_asof(
        tables["published"].sort_values("acceleration"), states, on="acceleration", direction="nearest"
    )
    found = rows[rows.state == state].dimension
    return f"{found.min():.2f} to {found.max():.2f}"
