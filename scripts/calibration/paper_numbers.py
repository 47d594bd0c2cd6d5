"""The paper's numbers for any conveyor, measured as in the claims but with fewer heights.

The amplitudes and heights at which states of motion change follow from the edges of a contact (see edges), which hold
for all angles and frictions. Each conveyor needs only four trajectories: both states of motion at both ends of the
interval in which the paper states their velocities.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.interpolate import CubicSpline, RegularGridInterpolator
from scipy.sparse.linalg import spsolve

from calibration.edges import HEIGHTS, SCAN, TOLERANCE, VERTICAL_OF, converged_states, find_edges
from calibration.search_space import coordinates_of, values_at
from conveyor import (
    LAST,
    NO_ATTRACTORS,
    UNITS,
    Hyperbola,
    mean_squared_error,
    sample_runs,
    set_parameters,
    sweep,
)
from conveyor.elementary import log, sin
from motion.critical import find_states
from pipeline import grid
from pipeline.rule_log import JobError

# Searched parameters in order, with their units; all of them by their logarithms.
PARAMETERS = {name: UNITS[name] for name in ("friction", "damping", "stiffness", "angle")}
CONTACT = [list(PARAMETERS).index(name) for name in ("damping", "stiffness")]
CONVERGED, EULER = "converged", "euler"
MM, CM = 1e3, 1e2
FINE = 1001  # heights at which the curve through the edges is evaluated
DURATION = 1.0  # s, of the four trajectories
# Distance (m/s²) from the ends of the interval of two states at which velocities are computed: one step of
# sweeps.amplitudes.
INSIDE = 0.25
# Scan for the edges of the paper's method: distances from the converged edges, m/s².
AROUND = np.array([-0.6, -0.3, 0.0, 0.3, 0.6])

Follow = Callable[[np.ndarray], np.ndarray]


def searched(settings: dict, **changed: float) -> np.ndarray:
    """Coordinates of the searched parameters, shape (1, 4): the printed values, or changed ones."""
    return coordinates_of(settings["model"] | changed, settings, PARAMETERS)


def parameters_at(x: np.ndarray, tension: str, settings: dict) -> np.ndarray:
    """A table of parameters, shape (n,), of the model with other searched parameters and another tension mode.

    x : coordinates of the searched parameters, shape (n, 4)
    """
    model = settings["model"]
    rows = np.full(len(x), grid.row_of(model | {"z0": 0.0}))
    columns = values_at(x, settings, PARAMETERS)
    if "static_friction" in model:
        columns["static_friction"] = np.maximum(model["static_friction"], columns["friction"])
    set_parameters(rows, columns | {"tension": tension})
    return rows


def interpolate_edges(table: pd.DataFrame) -> dict[str, RegularGridInterpolator]:
    """For each tension mode, a spline over the logarithms of loss and group; its values are the edges at all heights.

    Raises
    ------
    JobError
        if a row of the table has no edge, because the searched ranges are too wide
    """
    if table.vertical_acceleration.isna().any():
        row = table[table.vertical_acceleration.isna()].iloc[0]
        raise JobError(
            f"no edge was found at the loss {row.loss:.3g}, the group {row.group:.3g} and z0 = {row.z0:g} m; narrow "
            "IDENTIFIED in scripts/calibration/settings.py, or widen SCAN in scripts/calibration/edges.py"
        )
    table = table.sort_values(["loss", "group", "z0"])
    axes = [table[name].unique() for name in ("loss", "group", "z0")]
    return {
        tension: RegularGridInterpolator(
            (log(axes[0]), log(axes[1])),
            rows.vertical_acceleration.to_numpy().reshape([len(axis) for axis in axes]),
            "cubic",
            bounds_error=False,  # points at the bounds, up to rounding, are extrapolated
            fill_value=None,
            solver=spsolve,
        )
        for tension, rows in table.groupby("tension")
    }


class Curve(NamedTuple):
    """Amplitude at the edge over the initial height: heights (m, shape (k,)), amplitudes (m/s², shape (n, k))."""

    heights: np.ndarray
    amplitudes: np.ndarray

    def at(self, heights: np.ndarray) -> np.ndarray:
        """Amplitudes at the edge, shape (n, m), at some heights (m, shape (m,))."""
        return np.array([np.interp(heights, self.heights, amplitudes) for amplitudes in self.amplitudes])

    def critical_height(self, acceleration: np.ndarray) -> np.ndarray:
        """Lowest height (m) that does not lead to the first state, at amplitudes of shape (n, m): the same shape.

        The lowest height of the curve if all heights leave the first state, the height of its lowest edge if none does.
        """
        heights = np.empty_like(acceleration)
        for row, (wanted, amplitudes) in enumerate(zip(acceleration, self.amplitudes, strict=True)):
            falling = np.minimum.accumulate(amplitudes[: amplitudes.argmin() + 1])
            heights[row] = np.interp(-wanted, -falling, self.heights[: len(falling)])
        return heights


def converged_velocities(rows: np.ndarray) -> np.ndarray:
    """Mean feeding velocities (m/s), shape (n,), of a table of parameters, shape (n,), by the converged solution."""
    # The checks of `sweep` would add a seventh to a search that needs four trajectories at a time.
    times = np.full((len(rows), 2), [(1.0 - LAST) * DURATION, DURATION])
    x = sample_runs(rows, times, columns=["x"], tolerance=TOLERANCE).x
    return (x[:, 1] - x[:, 0]) / (LAST * DURATION)


def parameters_of_both_states(parameters: np.ndarray, curve: Curve, interval: list[float], inside: float) -> np.ndarray:
    """Parameter vectors that lead to each state at both ends of the interval of Fig. 9: shape (n, 2, 2).

    The axes after the first one are state and end. If both states do not coexist at an end, the nearest amplitude at
    which they do replaces it, moved inside by a step of the amplitude axis. The initial height of the first state is
    the middle of the heights that lead to it; the initial height of the second state is the height of the lowest edge.
    """
    low, high = interval
    low = np.maximum(low, curve.amplitudes.min(axis=1) + inside)
    high = np.minimum(high, curve.amplitudes.max(axis=1) - inside)
    rows = np.tile(parameters[:, None, None], (1, 2, 2))
    rows["acceleration"][..., 0], rows["acceleration"][..., 1] = low[:, None], high[:, None]
    rows["z0"][:, 0] = 0.5 * curve.critical_height(np.stack([low, high], axis=1))
    rows["z0"][:, 1] = curve.heights[curve.amplitudes.argmin(axis=1)][:, None]
    return rows


def changes_of_state(curve: Curve, measured: dict, step: float) -> dict[str, np.ndarray]:
    """Amplitudes and heights of changes of state, by CLAIM.QUANTITY, each of shape (n,), in the claims' units."""
    fig_8, fig_11 = (curve.at(np.linspace(*measured[name])) for name in ("starts", "moved_starts"))
    low, high = measured["interval"]
    # The critical height is largest at the lower end of the interval, or where the second state begins above it. It
    # hardly depends on the amplitude there; the slope of Eq. 13 is added so that a search moves to the paper's value.
    lowest = np.maximum(low, curve.amplitudes.min(axis=1))
    triple = Hyperbola(**measured["triple"])
    missing = triple.A / (triple.B + low) ** 2 * (lowest - low)
    given, fitted = list(measured["critical"].values()), np.linspace(low, high, round((high - low) / step) + 1)
    amplitudes = np.tile([*given, *fitted], (len(lowest), 1))
    heights = curve.critical_height(np.column_stack([lowest, amplitudes]))
    return {
        "C01.critical_amplitude": fig_8[:, 0],
        "C02.lower_end": fig_8.min(axis=1),
        "C02.upper_end": fig_8.max(axis=1),
        "C04.largest_height": MM * (heights[:, 0] + missing),
        **{f"{name}.height": MM * heights[:, 1 + k] for k, name in enumerate(measured["critical"])},
        "C09.error": mean_squared_error(fitted, heights[:, 1 + len(given) :], triple),
        "C10.lower_end": fig_11.min(axis=1),
        "C10.upper_end": fig_11.max(axis=1),
    }


def measure(
    parameters: np.ndarray, edges: np.ndarray, settings: dict, follow: Follow | None = converged_velocities
) -> dict[str, np.ndarray]:
    """The quantities of conveyors, by CLAIM.QUANTITY, each of shape (n,), in the units of the claims.

    Parameters
    ----------
    parameters : table, shape (n,); their acceleration and initial condition are not used
    edges : vertical amplitudes at the edges of HEIGHTS, m/s², shape (n, h)
    settings : of the rule
    follow : function from parameter vectors to mean velocities (m/s); None for the changes of state only
    """
    measured = settings["measured"]
    fine = np.linspace(HEIGHTS[0], HEIGHTS[-1], FINE)
    splines = CubicSpline(HEIGHTS, edges, axis=1)
    curve = Curve(fine, splines(fine) / sin(parameters["angle"])[:, None])
    changes = changes_of_state(curve, measured, INSIDE)
    if follow is None:
        return changes
    rows = parameters_of_both_states(parameters, curve, measured["interval"], INSIDE)
    first, second = np.moveaxis(CM * follow(rows.ravel()).reshape(rows.shape), 1, 0)
    return changes | {
        "C05.velocity_at_lower_end": first[:, 0],
        "C05.velocity_at_upper_end": first[:, 1],
        "C06.fall": second[:, 0] - second[:, 1],
    }


def measure_by_table(
    x: np.ndarray,
    splines: dict[str, RegularGridInterpolator],
    tension: str,
    settings: dict,
    follow: Follow | None = converged_velocities,
) -> dict[str, np.ndarray]:
    """The quantities at searched parameters, shape (n, 4), with interpolated edges and by the converged solution."""
    edges = splines[VERTICAL_OF[tension]](x[:, CONTACT])
    return measure(parameters_at(x, tension, settings), edges, settings, follow)


def edges_directly(
    x: np.ndarray, method: str, settings: dict, threads: int, heights: Sequence[float] = HEIGHTS
) -> np.ndarray:
    """Vertical edges (m/s²), shape (1, h), of the printed contact treatment at searched parameters, shape (1, 4).

    The paper's method runs for its duration, and the converged solution continues from there, as in the claims.
    """
    model, euler = settings["model"], settings["euler"]
    rows = np.repeat(parameters_at(x, model["tension"], settings), len(heights))
    rows["angle"], rows["z0"] = 0.5 * np.pi, heights
    converged = find_edges(rows, SCAN, converged_states(threads))
    if method == CONVERGED:
        return converged[None]

    def states(selected: np.ndarray) -> np.ndarray:
        return find_states(selected, euler, NO_ATTRACTORS, None, threads)

    return find_edges(rows, converged + AROUND[:, None], states)[None]


def measure_directly(x: np.ndarray, method: str, settings: dict, threads: int) -> dict[str, np.ndarray]:
    """The quantities at searched parameters, shape (1, 4), without interpolation, by one of both methods."""
    run = {name: settings["euler"][name] for name in ("duration", "method", "step")}

    def follow_by_euler(rows: np.ndarray) -> np.ndarray:
        return sweep(rows, chunk=1, threads=threads, **run)["mean_velocity"]

    follow = converged_velocities if method == CONVERGED else follow_by_euler
    parameters = parameters_at(x, settings["model"]["tension"], settings)
    return measure(parameters, edges_directly(x, method, settings, threads), settings, follow)
