"""The quantities of the claims at the printed parameters, by both methods, and at variants of these parameters."""

import numpy as np
import pandas as pd

from conveyor import ensemble
from conveyor.analysis.attractors.attractor_table import NO_ATTRACTORS
from conveyor.analysis.basins.hyperbola_fit import fit_least_squares
from conveyor.solver.model import ANGLE, Z0
from identification import edges as edge_search
from identification import measures
from identification.misfits import misfit
from identification.search_space import PARAMETERS, packed
from motion.critical import find_states
from pipeline import fields

NUMBERS = (
    fields.text("set", "set of parameters: printed, a variant, or the set of evidence that they fit best"),
    fields.text("method", "converged, or euler for the paper's method"),
    fields.text("tension", "mode of a tensile contact force"),
    *(fields.number(name, unit, "parameter") for name, unit in PARAMETERS.items()),
    fields.text("number", "CLAIM.QUANTITY"),
    fields.text("is", "name of the quantity, with its unit"),
    fields.number("paper", "see is", "the paper's number; null for none"),
    fields.number("low", "see is", "smallest accepted number; null for none"),
    fields.number("high", "see is", "largest accepted number"),
    fields.number("value", "see is", "measured with the edges of this contact"),
    fields.number("interpolated", "see is", "measured with interpolated edges; null for the paper's method"),
    fields.number("misfit", "1", "distance from the middle of the accepted interval over half its width"),
)
TABLES = {"printed": NUMBERS}
CONVERGED, EULER = "converged", "euler"
# Scan for the edges of the paper's method: distances from the converged edges, m/s².
AROUND = np.array([-0.6, -0.3, 0.0, 0.3, 0.6])


def edges_at(values: np.ndarray, tension: str, method: str, settings: dict, threads: int) -> np.ndarray:
    """Vertical edges (m/s², shape (h,)) at values of the parameters, shape (4,), by one of both methods.

    The paper's method runs for its duration, and the converged solution continues from there, as in the claims.
    """
    heights = np.array(settings["heights"])
    rows = np.repeat(packed(values[None], tension, settings["model"]), len(heights), axis=0)
    rows[:, ANGLE], rows[:, Z0] = 0.5 * np.pi, heights
    converged = edge_search.search_edges(rows, settings, edge_search.converged_states(threads))
    if method == CONVERGED:
        return converged
    return edge_search.search_edges(
        rows,
        settings,
        lambda selected: find_states(selected, settings["euler"], NO_ATTRACTORS, threads),
        converged + AROUND[:, None],
    )


def velocities_by(method: str, settings: dict, threads: int) -> measures.Follow:
    """The function that computes mean feeding velocities (m/s) by one of both methods."""
    if method == CONVERGED:
        return measures.converged_velocities
    run = {name: settings["euler"][name] for name in ("duration", "method", "step")}
    return lambda rows: ensemble.run(rows, chunk=1, threads=threads, **run)["mean_velocity"]


def measure(values: np.ndarray, tension: str, method: str, settings: dict, threads: int) -> dict[str, float]:
    """All quantities at values of the parameters, shape (4,), and A, B and C of the fit of Eq. 13 to them."""
    heights, claims = np.array(settings["heights"]), settings["measured"]
    parameters = packed(values[None], tension, settings["model"])
    edges = edges_at(values, tension, method, settings, threads)[None]
    found = measures.quantities(parameters, heights, edges, claims, velocities_by(method, settings, threads))
    amplitudes = measures.fitted_amplitudes(claims)
    critical = measures.edge_curve(heights, edges, parameters[:, ANGLE]).critical_height(amplitudes[None])[0]
    triple = fit_least_squares(amplitudes, critical, tuple(claims["bounds_of_b"])).parameters
    return {name: float(value[0]) for name, value in found.items()} | {
        f"C09.{name}": value for name, value in triple._asdict().items()
    }


def number_rows(
    name: str, values: np.ndarray, tension: str, method: str, edges: measures.Edges, settings: dict, threads: int
) -> pd.DataFrame:
    """Rows of a table of numbers for one set of parameters."""
    direct = measure(values, tension, method, settings, threads)
    interpolated = {}
    if method == CONVERGED:
        interpolated = measures.quantities_at(edges, values[None], tension, settings)
    numbers = settings["numbers"]
    table = pd.DataFrame(
        {
            "number": list(numbers),
            "is": [one["is"] for one in numbers.values()],
            **{part: [one[part] for one in numbers.values()] for part in ("paper", "low", "high")},
            "value": [direct[one] for one in numbers],
            "interpolated": [float(interpolated[one][0]) if one in interpolated else np.nan for one in numbers],
            "misfit": [float(misfit(direct[name], one)) for name, one in numbers.items()],
        }
    )
    return table.assign(set=name, method=method, tension=tension, **dict(zip(PARAMETERS, values, strict=True)))


def make(edges: pd.DataFrame, settings: dict, *, threads: int = 1) -> pd.DataFrame:
    """The table of numbers at the printed parameters and at their variants."""
    model = settings["model"]
    interpolated = measures.interpolate_edges(edges)
    found = []
    for name, variant in settings["reported"].items():
        values = np.array([(model | variant)[parameter] for parameter in PARAMETERS])
        for method in (CONVERGED, EULER) if not variant else (CONVERGED,):
            found.append(number_rows(name, values, model["tension"], method, interpolated, settings, threads))
    return pd.concat(found)
