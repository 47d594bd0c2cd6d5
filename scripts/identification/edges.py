"""Up to which amplitude each initial height leads to the first state, over the parameters of the contact.

The vertical motion knows friction not at all, the angle of throw only by the vertical amplitude a_z = â sin φ, and
`frictionless` not from `allow`: what is found here once for a contact serves all of them.
"""

from collections.abc import Callable

import numpy as np

from conveyor.analysis.attractors.labels import classify
from conveyor.parameters import normal_gravity
from conveyor.solver.model import ACCELERATION, PARAMETERS, TENSION, TENSION_MODES
from pipeline import fields, grid

TABLES = {
    "edges": (
        fields.number("loss", "1", "share of an impact's speed that damping takes, roughly: see impact_loss"),
        fields.number("stiffness", "N/m^p", "contact stiffness"),
        fields.text("tension", "reading of a contact force that pulls: allow (as frictionless) or clip"),
        fields.number("z0", "m", "initial height"),
        fields.number("damping", "N s/m", "contact damping, from loss and stiffness"),
        fields.number(
            "vertical_acceleration",
            "m/s²",
            "vertical amplitude above which the start no longer ends in the first state",
        ),
    ),
}
# Readings of the contact force with a vertical motion of their own, and which of them each reading has.
VERTICAL = ("allow", "clip")
VERTICAL_OF = {"allow": "allow", "frictionless": "allow", "clip": "clip"}
# Excitation cycles after which a start that has not settled is not in the first state: that takes some fifty.
CYCLES = 1000
# Steps in which the first state is looked for above an edge.
FURTHER = 10
# Of the contact steps (see figure scene_budget).
TOLERANCE = 1e-6

Decide = Callable[[np.ndarray], np.ndarray]


def duration_over_mass(stiffness: np.ndarray, model: dict) -> np.ndarray:
    """Duration of an impact at the speed g cos α/ω over the part's mass (s/kg), but for a number of order one.

    From the dimensions of m z̈ = k z^p: T = (m/k)^(1/(p+1)) v^((1-p)/(p+1)).
    """
    p, mass = model["exponent"], model["mass"]
    speed = normal_gravity(model) / (2.0 * np.pi * model["frequency"])
    return (mass / stiffness) ** (1.0 / (p + 1.0)) * speed ** ((1.0 - p) / (p + 1.0)) / mass


def impact_loss(damping: np.ndarray, stiffness: np.ndarray, model: dict) -> np.ndarray:
    """d_c T / m: what the damping takes of the speed of an impact, to first order and but for a number of order one.

    Contacts of one loss have nearly one coefficient of restitution: along lines of equal loss in the plane of damping
    and stiffness the edges change least, and a table over it has no corners in which nothing jumps, or everything.
    """
    return damping * duration_over_mass(stiffness, model)


def edge(
    parameters: np.ndarray, scan: np.ndarray, further: np.ndarray, resolution: float, decide: Decide
) -> np.ndarray:
    """Amplitude (m/s²) above which starts no longer end in the first state, shape (n,); NaN for none in the scan.

    A scan from below finds where a start leaves the first state, bisection locates that. Below the edge there may be
    tongues, narrow intervals of amplitudes at which the start ends otherwise: if the first state comes back at one of
    the amplitudes `further` above, the search goes on from there. (It must not begin from above: far above the edge
    there are motions without a long flight that have nothing to do with it.)

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows as from model.pack; their acceleration is not used
    scan : amplitudes, m/s², ascending, shape (k,), or (k, n) for a scan of each row
    further : equal steps above an edge at which the first state is looked for, m/s², shape (s,)
    resolution : m/s², to which the amplitude is enclosed
    decide : states of motion, str, shape (m,), for parameters of shape (m, 16)
    """
    n = len(parameters)
    scan = np.broadcast_to(scan.T, (n, len(scan))).T
    low, high = np.full(n, np.nan), np.full(n, np.nan)

    def is_first(rows: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        at = np.array(parameters[rows], dtype=np.float64)
        at[:, ACCELERATION] = amplitude
        return decide(at) == "first"

    def narrow(rows: np.ndarray) -> None:
        while (wide := rows[high[rows] - low[rows] > resolution]).size:
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
    todo = found = np.flatnonzero(np.isfinite(low + high))
    while len(todo):
        narrow(todo)
        looked = high[todo, None] + further
        back = is_first(np.repeat(todo, len(further)), looked.ravel()).reshape(looked.shape)
        tongue = back.any(axis=1)
        todo, looked, back = todo[tongue], looked[tongue], back[tongue]
        low[todo] = np.where(back, looked, -np.inf).max(axis=1, initial=-np.inf)
        high[todo] = low[todo] + further[0]
    middle = np.full(n, np.nan)
    middle[found] = 0.5 * (low + high)[found]
    return middle


def conveyors(settings: dict) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """The columns of the table that are given, shape (n,), and the parameters, shape (n, 16), of its rows.

    The plate of these conveyors moves vertically, so that their amplitude is the vertical one.
    """
    model = settings["model"]
    axes = {name: np.geomspace(*settings["bounds"][name], number) for name, number in settings["contacts"].items()}
    axes |= {"tension": np.array(VERTICAL), "z0": np.array(settings["heights"], dtype=np.float64)}
    columns = dict(zip(axes, map(np.ravel, np.meshgrid(*axes.values(), indexing="ij")), strict=True))
    columns["damping"] = columns["loss"] / duration_over_mass(columns["stiffness"], model)
    _, one = grid.product(
        {"angle": [0.5 * np.pi]}, {name: model[name] for name in model if name not in ("angle", "z0")}
    )
    parameters = np.tile(one, (len(columns["loss"]), 1))
    parameters[:, TENSION] = [TENSION_MODES.index(reading) for reading in columns["tension"]]
    for name in ("stiffness", "damping", "z0"):
        parameters[:, PARAMETERS.index(name)] = columns[name]
    return columns, parameters


def by_events(threads: int) -> Decide:
    """The states of motion that starts end in, converged."""
    return lambda rows: classify(rows, cycles=CYCLES, tolerance=TOLERANCE, threads=threads).state


def edges_of(parameters: np.ndarray, settings: dict, decide: Decide, scan: np.ndarray | None = None) -> np.ndarray:
    """The edges of starts, as `edge` finds them with the settings, or in another scan."""
    search = settings["edges"]
    span = search["vertical_acceleration"]
    scan = np.linspace(span["start"], span["stop"], span["num"]) if scan is None else scan
    further = search["further"] / FURTHER * np.arange(1.0, FURTHER + 1.0)
    return edge(parameters, scan, further, search["resolution"], decide)


def make(settings: dict, *, threads: int = 1) -> dict[str, np.ndarray]:
    """The columns of the table of edges for the settings of the rule."""
    columns, parameters = conveyors(settings)
    return columns | {"vertical_acceleration": edges_of(parameters, settings, by_events(threads))}
