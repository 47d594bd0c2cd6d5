"""Sect. 4 of the paper: chaotic motion, Lyapunov exponents, phase portraits and their dimensions."""

import numpy as np
import pandas as pd

from findings.finding import Finding, lowest, onset


def no_period(tables: dict[str, pd.DataFrame]) -> Finding:
    """C15: share of the starts that do not settle to a period (up to 64 cycles) in a long run."""
    return Finding(*((float((tables[role].period == 0).mean()),) for role in ("published", "converged")))


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
    settled = states[(states.acceleration >= 50.0) & (states.acceleration < found["converged"])]
    settled = settled[settled.z0 == settled.z0.min()]
    medians = {
        role: tables[role][tables[role].acceleration.between(50.0, found["converged"])]["lambda"].median()
        for role in found
    }
    reason = (
        f"between 50 and {found['converged']:g} m/s² the estimate's median is {medians['published']:+.2f} 1/s by Euler "
        f"and {medians['converged']:+.2f} 1/s converged; "
        f"{100 * (settled.period > 0).mean():.0f} % of these amplitudes settle to a period"
    )
    return Finding((found["published"],), (found["converged"],), reason)


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
        f"and {positive_onset(tables['published_exponent']):g} m/s²"
    )
    return Finding(found[0], found[1], reason)
