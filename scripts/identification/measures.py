"""The quantities of the paper's claims for any conveyor, measured as in the claims but with fewer heights.

The amplitudes and heights at which states of motion change follow from the edges of a contact (see edges), which hold
for all angles and frictions. Each conveyor needs only four trajectories: both states of motion at both ends of the
interval in which the paper states their velocities.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.interpolate import CubicSpline, NdBSpline, make_interp_spline

from conveyor import ensemble
from conveyor.analysis.basins.hyperbola import Hyperbola, mean_squared_error
from conveyor.solver.model import ACCELERATION, ANGLE, DAMPING, STIFFNESS, Z0
from identification.edges import VERTICAL, VERTICAL_OF, impact_loss
from identification.search_space import packed

MM, CM = 1e3, 1e2
# Heights at which the curve through the edges is evaluated.
FINE = 1001
# Of the four trajectories, s, and of their contact steps (see figure scene_budget).
DURATION, TOLERANCE = 1.0, 1e-6

Follow = Callable[[np.ndarray], np.ndarray]


class Edges(NamedTuple):
    """Interpolated edges of contacts: heights (m), and a spline for each tension mode with one value per height."""

    heights: np.ndarray
    splines: dict[str, NdBSpline]


def interpolate_edges(table: pd.DataFrame) -> Edges:
    """Splines through the table of edges over the logarithms of loss and stiffness.

    Raises
    ------
    ValueError
        if a row of the table has no edge, because the bounds of the config are too wide
    """
    if table.vertical_acceleration.isna().any():
        row = table[table.vertical_acceleration.isna()].iloc[0]
        raise ValueError(
            f"no edge was found at the loss {row.loss:.3g}, the stiffness {row.stiffness:.3g} and z0 = {row.z0:g} m; "
            "narrow identification.contacts, or widen identification.edges.vertical_acceleration"
        )
    axes = [np.sort(table[name].unique()) for name in ("loss", "stiffness", "z0")]
    splines = {}
    for tension in VERTICAL:
        rows = table[table.tension == tension].sort_values(["loss", "stiffness", "z0"])
        values = rows.vertical_acceleration.to_numpy().reshape([len(axis) for axis in axes])
        along_loss = make_interp_spline(np.log(axes[0]), values, axis=0)
        along_stiffness = make_interp_spline(np.log(axes[1]), along_loss.c, axis=1)
        coefficients = np.moveaxis(along_stiffness.c, 0, 1)  # SciPy puts the interpolated axis first
        splines[tension] = NdBSpline((along_loss.t, along_stiffness.t), coefficients, 3)
    return Edges(axes[2], splines)


def vertical_edges(edges: Edges, parameters: np.ndarray, tension: str, model: dict) -> np.ndarray:
    """Vertical amplitudes (m/s²) of the edges, shape (n, h), of conveyors, shape (n, 16), in a tension mode."""
    loss = impact_loss(parameters[:, DAMPING], parameters[:, STIFFNESS], model)
    return edges.splines[VERTICAL_OF[tension]](np.log(np.stack([loss, parameters[:, STIFFNESS]], axis=1)))


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


@lru_cache
def spline_weights(heights: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Fine heights, shape (k,), and the weights there of the values at `heights` in a cubic spline, shape (h, k)."""
    fine = np.linspace(heights[0], heights[-1], FINE)
    return fine, CubicSpline(heights, np.eye(len(heights)), axis=1)(fine)


def edge_curve(heights: np.ndarray, edges: np.ndarray, angle: np.ndarray) -> Curve:
    """The Curve of conveyors with the given angles (rad, shape (n,)) from vertical edges of shape (n, h)."""
    fine, weights = spline_weights(tuple(heights))
    # Not @, because its rounding may depend on the number of conveyors.
    return Curve(fine, np.einsum("nh,hk->nk", edges, weights) / np.sin(angle)[:, None])


def converged_velocities(rows: np.ndarray) -> np.ndarray:
    """Mean feeding velocities (m/s), shape (n,), of parameter vectors, shape (n, 16), by the converged solution."""
    # The overhead of ensemble.run would add a seventh to a search that needs four trajectories at a time.
    return ensemble.follow_by_events(rows, np.full(len(rows), DURATION), TOLERANCE, True)["mean_velocity"]


def parameters_of_both_states(parameters: np.ndarray, found: Curve, measured: dict) -> np.ndarray:
    """Parameter vectors that lead to each state at both ends of the interval of Fig. 9: shape (n, 2, 2, 16).

    The axes after the first one are state and end. If both states do not coexist at an end, the nearest amplitude at
    which they do replaces it, moved inside by a step of the amplitude axis. The initial height of the first state is
    the middle of the heights that lead to it; the initial height of the second state is the height of the lowest edge.
    """
    inside = measured["inside"]
    low, high = measured["interval"]
    low = np.maximum(low, found.amplitudes.min(axis=1) + inside)
    high = np.minimum(high, found.amplitudes.max(axis=1) - inside)
    rows = np.tile(parameters[:, None, None, :], (1, 2, 2, 1))
    rows[..., 0, ACCELERATION], rows[..., 1, ACCELERATION] = low[:, None], high[:, None]
    rows[:, 0, :, Z0] = 0.5 * found.critical_height(np.stack([low, high], axis=1))
    rows[:, 1, :, Z0] = found.heights[found.amplitudes.argmin(axis=1)][:, None]
    return rows


def fitted_amplitudes(measured: dict) -> np.ndarray:
    """Amplitudes (m/s²) at which Eq. 13 is compared with critical heights, with the spacing of the claims."""
    low, high = measured["interval"]
    return np.linspace(low, high, round((high - low) / measured["inside"]) + 1)


def changes_of_state(found: Curve, measured: dict) -> dict[str, np.ndarray]:
    """Amplitudes and heights of changes of state, by CLAIM.QUANTITY, each of shape (n,), in the claims' units."""
    fig_8, fig_11 = (found.at(np.linspace(*measured[name])) for name in ("starts", "moved_starts"))
    low, _ = measured["interval"]
    n = len(found.amplitudes)
    # The critical height is largest at the lower end of the interval, or where the second state begins above it. It
    # hardly depends on the amplitude there; the slope of Eq. 13 is added so that a search moves to the paper's value.
    lowest = np.maximum(low, found.amplitudes.min(axis=1))
    triple = Hyperbola(**measured["triple"])
    missing = triple.A / (triple.B + low) ** 2 * (lowest - low)
    given, fitted = list(measured["critical"].values()), fitted_amplitudes(measured)
    heights = found.critical_height(np.column_stack([lowest, np.tile([*given, *fitted], (n, 1))]))
    deviations = mean_squared_error(fitted, heights[:, 1 + len(given) :], triple)
    return {
        "C01.critical_amplitude": fig_8[:, 0],
        "C02.lower_end": fig_8.min(axis=1),
        "C02.upper_end": fig_8.max(axis=1),
        "C04.largest_height": MM * (heights[:, 0] + missing),
        **{f"{name}.height": MM * heights[:, 1 + k] for k, name in enumerate(measured["critical"])},
        "C09.error": deviations,
        "C10.lower_end": fig_11.min(axis=1),
        "C10.upper_end": fig_11.max(axis=1),
    }


def velocities(parameters: np.ndarray, found: Curve, measured: dict, follow: Follow) -> dict[str, np.ndarray]:
    """Velocities of the states, by CLAIM.QUANTITY, each of shape (n,), in cm/s."""
    rows = parameters_of_both_states(parameters, found, measured)
    first, second = np.moveaxis(CM * follow(rows.reshape(-1, rows.shape[-1])).reshape(rows.shape[:3]), 1, 0)
    return {
        "C05.velocity_at_lower_end": first[:, 0],
        "C05.velocity_at_upper_end": first[:, 1],
        "C06.fall": second[:, 0] - second[:, 1],
    }


def quantities(
    parameters: np.ndarray, heights: np.ndarray, edges: np.ndarray, measured: dict, follow: Follow
) -> dict[str, np.ndarray]:
    """All quantities of conveyors, by CLAIM.QUANTITY, each of shape (n,), in the units of the claims.

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows as from model.pack; their acceleration and initial condition are not used
    heights, edges : heights, m, shape (h,), and the vertical edges there, m/s², shape (n, h)
    measured : settings of the claims: `interval` of amplitudes and the distance `inside` its ends at which velocities
        are taken (m/s²), initial heights `starts` and `moved_starts` of Figs. 8 and 11 (first, last and number, m),
        `critical` amplitudes by claim (m/s²), and A, B and C of Eq. 13, `triple`
    follow : function from parameter vectors to mean velocities (m/s)
    """
    found = edge_curve(heights, edges, parameters[:, ANGLE])
    return changes_of_state(found, measured) | velocities(parameters, found, measured, follow)


def quantities_at(edges: Edges, values: np.ndarray, tension: str, settings: dict) -> dict[str, np.ndarray]:
    """The quantities at values of the parameters, shape (n, 4), in a tension mode, with interpolated edges and by the
    converged solution.
    """
    parameters = packed(values, tension, settings["model"])
    vertical = vertical_edges(edges, parameters, tension, settings["model"])
    return quantities(parameters, edges.heights, vertical, settings["measured"], converged_velocities)
