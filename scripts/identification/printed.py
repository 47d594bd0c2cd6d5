"""The paper's numbers at the printed parameters, by both methods, and at variants of them."""

import numpy as np
import pandas as pd

from conveyor import ensemble
from conveyor.analysis.attractors.attractor_table import NO_ATTRACTORS
from conveyor.analysis.basins.hyperbola_fit import fit_least_squares
from conveyor.solver.model import ANGLE, Z0
from identification import edges as of_edges
from identification import measures
from identification.misfits import misfit, number
from identification.search_space import PARAMETERS, packed
from motion.critical_heights import decide
from pipeline import fields

NUMBERS = (
    fields.text("set", "set of parameters: printed, a variant of it, or a set of evidence that these fit best"),
    fields.text("method", "converged, or euler for the paper's"),
    fields.text("tension", "reading of a contact force that pulls"),
    *(fields.number(name, unit, "value") for name, unit in PARAMETERS.items()),
    fields.text("number", "CLAIM.QUANTITY"),
    fields.text("is", "what it is, with its unit"),
    fields.number("paper", "see is", "the paper's number; null for none"),
    fields.number("low", "see is", "least accepted number; null for none"),
    fields.number("high", "see is", "largest accepted number"),
    fields.number("value", "see is", "measured, with the edges of this very contact"),
    fields.number("interpolated", "see is", "with the interpolated edges; null for the paper's method"),
    fields.number("misfit", "1", "distance from the middle of the accepted interval over half its width"),
)
TABLES = {"printed": NUMBERS}
CONVERGED, EULER = "converged", "euler"
# Around the converged edges, m/s², those of the paper's method are looked for.
AROUND = np.array([-0.6, -0.3, 0.0, 0.3, 0.6])


def edges_at(values: np.ndarray, reading: str, method: str, settings: dict, threads: int) -> np.ndarray:
    """Vertical edges (m/s², shape (h,)) of the contact of these values, shape (4,), by one of both methods.

    The paper's is followed for its duration, and the converged solution goes on from there, as in the claims.
    """
    heights = np.array(settings["heights"])
    rows = np.repeat(packed(values[None], reading, settings["model"]), len(heights), axis=0)
    rows[:, ANGLE], rows[:, Z0] = 0.5 * np.pi, heights
    found = of_edges.edges_of(rows, settings, of_edges.by_events(threads))
    if method == CONVERGED:
        return found
    return of_edges.edges_of(
        rows, settings, lambda some: decide(some, settings["euler"], NO_ATTRACTORS, threads), found + AROUND[:, None]
    )


def velocities_by(method: str, settings: dict, threads: int) -> measures.Follow:
    """Mean feeding velocities (m/s) by one of both methods."""
    if method == CONVERGED:
        return measures.by_events
    run = {name: settings["euler"][name] for name in ("duration", "method", "step")}
    return lambda rows: ensemble.run(rows, chunk=1, threads=threads, **run)["mean_velocity"]


def measured(values: np.ndarray, reading: str, method: str, settings: dict, threads: int) -> dict[str, float]:
    """All quantities at values of the parameters, shape (4,), and A, B and C of their own fit of Eq. 13."""
    heights, wanted = np.array(settings["heights"]), settings["measured"]
    parameters = packed(values[None], reading, settings["model"])
    edges = edges_at(values, reading, method, settings, threads)[None]
    found = measures.quantities(parameters, heights, edges, wanted, velocities_by(method, settings, threads))
    amplitudes = measures.fitted_amplitudes(wanted)
    critical = measures.curve(heights, edges, parameters[:, ANGLE]).critical_height(amplitudes[None])[0]
    triple = fit_least_squares(amplitudes, critical, tuple(wanted["bounds_of_b"])).parameters
    return {name: float(value[0]) for name, value in found.items()} | {
        f"C09.{name}": value for name, value in triple._asdict().items()
    }


def rows(
    name: str, values: np.ndarray, reading: str, method: str, edges: measures.Edges, settings: dict, threads: int
) -> pd.DataFrame:
    """Rows of a table of numbers for one set of parameters."""
    direct = measured(values, reading, method, settings, threads)
    quick = {}
    if method == CONVERGED:
        quick = measures.at(edges, values[None], reading, settings, measures.by_events)
    numbers = settings["numbers"]
    table = pd.DataFrame(
        {
            "number": list(numbers),
            "is": [one["is"] for one in numbers.values()],
            **{part: [one[part] for one in numbers.values()] for part in ("paper", "low", "high")},
            "value": [direct[one] for one in numbers],
            "interpolated": [float(quick[one][0]) if one in quick else np.nan for one in numbers],
            "misfit": [float(misfit(direct[name], number(one))) for name, one in numbers.items()],
        }
    )
    return table.assign(set=name, method=method, tension=reading, **dict(zip(PARAMETERS, values, strict=True)))


def make(edges: pd.DataFrame, settings: dict, *, threads: int = 1) -> dict[str, list]:
    """The columns of the table of numbers at the printed parameters and at variants of them."""
    model = settings["model"]
    interpolated = measures.edges_of(edges, model)
    found = []
    for name, variant in settings["told"].items():
        values = np.array([(model | variant)[parameter] for parameter in PARAMETERS])
        for method in (CONVERGED, EULER) if not variant else (CONVERGED,):
            found.append(rows(name, values, model["tension"], method, interpolated, settings, threads))
    return pd.concat(found).to_dict("list")
