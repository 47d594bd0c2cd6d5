"""Edges: the amplitude up to which each initial height leads to the first state, over the parameters of the contact.

The vertical motion does not depend on friction, depends on the angle of throw only through a_z = â sin φ, and is the
same for the tension modes `frictionless` and `allow`. The edges of a contact therefore hold for all frictions, all
angles, and both modes.
"""

from collections.abc import Callable

import numpy as np

from conveyor import classify, contact_of_groups, replace_parameters, set_parameters
from pipeline import fields, grid

TABLES = {
    "edges": (
        fields.number(
            "loss", "1", "group L of the contact: approximate share of the impact speed that damping dissipates"
        ),
        fields.number("group", "1", "group K of the contact: its dimensionless stiffness"),
        fields.text("tension", "mode of a tensile contact force: allow (also for frictionless) or clip"),
        fields.number("z0", "m", "initial height"),
        fields.number("stiffness", "N/m^p", "contact stiffness"),
        fields.number("damping", "N s/m", "contact damping"),
        fields.number("vertical_acceleration", "m/s²", "vertical amplitude up to which z0 leads to the first state"),
    ),
}
# Tension modes with different vertical motions, and the vertical motion of each mode.
VERTICAL = ("allow", "clip")
VERTICAL_OF = {"allow": "allow", "frictionless": "allow", "clip": "clip"}
# Numbers of losses and of groups in equal ratios within their bounds, by an effort of 1; a cubic spline needs four.
CONTACTS, LEAST_CONTACTS = 9, 4
# Initial heights (m): closer where the edge is steep.
HEIGHTS = (
    *(0.0, 1e-5, 2e-5, 3.5e-5, 5e-5, 7e-5, 1e-4, 1.3e-4),
    *(1.6e-4, 2e-4, 2.5e-4, 3e-4, 3.5e-4, 4e-4, 4.5e-4, 5e-4),
)
SCAN = np.linspace(1.0, 14.0, 23)  # vertical amplitudes (m/s²), from below: 5 to 67 m/s² at 12°
# Distances above an edge (m/s²) at which the first state may return; tongues are narrower.
FURTHER = 0.02 * np.arange(1.0, 11.0)
RESOLUTION = 2e-4  # m/s², largest width of the bracket of an edge: a thousandth of what a reader can see
# Excitation cycles after which an unsettled motion is not in the first state, which settles within about 50.
CYCLES = 1000
# Of the contact steps (see figure scene_budget).
TOLERANCE = 1e-6

Decide = Callable[[np.ndarray], np.ndarray]


def find_edges(parameters: np.ndarray, scan: np.ndarray, decide: Decide) -> np.ndarray:
    """Amplitude (m/s²) above which initial conditions no longer lead to the first state, shape (n,); NaN for none.

    A scan from below brackets the edge, and bisection locates it. Below the edge there may be tongues: narrow intervals
    of amplitudes with another state. If the first state returns at one of the distances FURTHER above, the search goes
    on from there. It cannot begin from above, because far above the edge there are unrelated motions without a long
    flight.

    Parameters
    ----------
    parameters : table, shape (n,); their acceleration is not used
    scan : ascending amplitudes, m/s², shape (k,), or (k, n) for a scan of each row
    decide : function from a table of parameters, shape (m,), to states of motion, str, shape (m,)
    """
    n = len(parameters)
    scan = np.broadcast_to(scan.T, (n, len(scan))).T
    low, high = np.full(n, np.nan), np.full(n, np.nan)

    def is_first(rows: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        selected = replace_parameters(parameters[rows], acceleration=amplitude)
        return decide(selected) == "first"

    def bisect(rows: np.ndarray) -> None:
        while (wide := rows[high[rows] - low[rows] > RESOLUTION]).size:
            middle = 0.5 * (low[wide] + high[wide])
            first = is_first(wide, middle)
            low[wide[first]] = middle[first]
            high[wide[~first]] = middle[~first]

    inside = np.arange(n)
    for amplitudes in scan:
        first = is_first(inside, amplitudes[inside])
        low[inside[first]] = amplitudes[inside[first]]
        high[inside[~first]] = amplitudes[inside[~first]]
        inside = inside[first]
    todo = bracketed = np.flatnonzero(np.isfinite(low + high))
    while len(todo):
        bisect(todo)
        above = high[todo, None] + FURTHER
        back = is_first(np.repeat(todo, len(FURTHER)), above.ravel()).reshape(above.shape)
        tongue = back.any(axis=1)
        todo, above, back = todo[tongue], above[tongue], back[tongue]
        low[todo] = np.where(back, above, -np.inf).max(axis=1, initial=-np.inf)
        high[todo] = low[todo] + FURTHER[0]
    middle = np.full(n, np.nan)
    middle[bracketed] = 0.5 * (low + high)[bracketed]
    return middle


def contacts_of(effort: float) -> int:
    """Number of losses, and of groups; an effort multiplies the number of contacts."""
    return max(LEAST_CONTACTS, round(CONTACTS * effort**0.5))


def conveyors(settings: dict) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """The columns of the table before the search, shape (n,), and the parameters of its rows, shape (n,).

    The plate moves vertically, so that the amplitude is the vertical amplitude.
    """
    model = settings["model"]
    count = contacts_of(settings["effort"])
    ranges = {"loss": settings["ranges"]["damping"], "group": settings["ranges"]["stiffness"]}
    axes = {name: np.geomspace(*ends, count) for name, ends in ranges.items()}
    axes |= {"tension": np.array(VERTICAL), "z0": np.array(HEIGHTS)}
    columns = dict(zip(axes, map(np.ravel, np.meshgrid(*axes.values(), indexing="ij")), strict=True))
    row = grid.row_of(model | {"angle": 0.5 * np.pi})
    columns["stiffness"], columns["damping"] = contact_of_groups(columns["group"], columns["loss"], row)
    parameters = np.full(len(columns["loss"]), row)
    set_parameters(parameters, {name: columns[name] for name in ("stiffness", "damping", "z0", "tension")})
    return columns, parameters


def converged_states(threads: int) -> Decide:
    """The function that determines states of motion by the converged solution."""
    return lambda rows: classify(rows, cycles=CYCLES, tolerance=TOLERANCE, threads=threads).state


def make(settings: dict, *, threads: int = 1) -> dict[str, np.ndarray]:
    """The columns of the table of edges for the settings of the rule."""
    columns, parameters = conveyors(settings)
    return columns | {"vertical_acceleration": find_edges(parameters, SCAN, converged_states(threads))}
