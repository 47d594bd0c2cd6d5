"""Whether a rigid bouncing part would do in place of the contact.

Its velocity and state over the amplitude beside those of the contact, and the amplitudes of the fold and of the period
doublings of its jumps, with a coefficient of restitution that is one number and with one that depends on the speed of
approach as it does in the contact.
"""

import math
from collections.abc import Sequence

import numpy as np
import pandas as pd

from conveyor.analysis.attractors import labels
from conveyor.methods import rigid_part_motion
from conveyor.methods.rigid_part_orbits import RigidOrbit, rigid_orbit
from conveyor.solver.model import (
    ACCELERATION,
    DAMPING,
    EXPONENT,
    FREQUENCY,
    MASS,
    STIFFNESS,
    TENSION,
    Conveyor,
    Start,
    pack,
)
from conveyor.solver.progress import bar
from pipeline import fields, grid

TABLES = {
    "rigid_part": (
        fields.text(
            "model", "contact, or a rigid part whose restitution depends on the speed of approach or is one number"
        ),
        fields.text("kind", "velocity, fold or period doubling"),
        fields.count("number", "number of the bifurcation from below; 0 for velocities"),
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.number("z0", "m", "initial height; null for bifurcations"),
        fields.number("mean_velocity", "m/s", "mean feeding velocity over the last quarter; null for bifurcations"),
        fields.text("state", "first, second, chaos or undecided; null for bifurcations"),
    ),
}

SPEEDS = np.geomspace(1e-3, 1.0, 64)  # m/s, of approach, at which the contact's restitution is tabulated
MAX_PERIOD = 64  # excitation cycles, of the motions that count as settled, as for the contact
OF_LAST_CYCLE = 50  # heights that tell how high a part jumps
CLOSE = 1e-2  # of the height of a jump: nearer than that, a motion has come back
CYCLES = 2000  # after which a rigid part has found its motion, or is called undecided
CONTACT_PARAMETERS = [STIFFNESS, DAMPING, MASS, EXPONENT, TENSION]  # on which restitution depends
CONTACT, RIGID, ONE_NUMBER = "contact", "rigid part, e(u)", "rigid part, one e"


def table_of_restitution(parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Speeds of approach (m/s) and coefficients of restitution of the contact in a parameter vector, shape (16,)."""
    return SPEEDS, rigid_part_motion.restitution_coefficients(parameters, SPEEDS)


def state_of(row: np.ndarray, restitution: tuple[np.ndarray, np.ndarray], cycles: int) -> str:
    """State of motion of a rigid part after some cycles: by its last flights, and by whether it repeats itself.

    What does not is `undecided`: chaos is a matter of exponents, which a rigid part has not been asked for.
    """
    duration, cycle = cycles / row[FREQUENCY], 1.0 / row[FREQUENCY]
    times = times_of_periods(row, duration, MAX_PERIOD)
    samples, hits = rigid_part_motion.samples_and_impacts(row, times, restitution)
    flights = np.diff(hits[hits["time"] > duration - 2.0 * MAX_PERIOD * cycle]["time"])
    if len(flights) == 0 or flights.max() < labels.LONG_FLIGHT * cycle:
        return "first"
    return "second" if period_of(samples["z"], range(1, MAX_PERIOD + 1)) else "undecided"


def times_of_periods(row: np.ndarray, duration: float, longest: int) -> np.ndarray:
    """Times (s) of the heights that `period_of` looks at: strobes of twice the `longest` period, and the last cycle."""
    cycles = np.concatenate([np.arange(2 * longest), np.linspace(0.0, 1.0, OF_LAST_CYCLE)])
    return duration - cycles / row[FREQUENCY]


def period_of(height: np.ndarray, periods: Sequence[int], close: float = CLOSE) -> int:
    """First of some periods (cycles) with which a rigid part repeats itself at the end of a run; 0 for none.

    height : m, at the `times_of_periods` of the longest of them
    """
    strobed, jump = height[:-OF_LAST_CYCLE], np.ptp(height[-OF_LAST_CYCLE:])
    for period in periods:
        if np.abs(strobed[period:] - strobed[:-period]).max() < close * jump:
            return period
    return 0


def swept(settings: dict, cycles: int = CYCLES) -> pd.DataFrame:
    """Mean velocities (m/s) and states of rigid parts, after some cycles, in place of those of a sweep."""
    axes, parameters = grid.product(settings["axes"], settings["model"])
    # Rows of one contact share its table of restitution.
    contacts, contact = np.unique(parameters[:, CONTACT_PARAMETERS], axis=0, return_inverse=True)
    tables_of_contacts = [table_of_restitution(parameters[np.argmax(contact == k)]) for k in range(len(contacts))]
    restitution = [tables_of_contacts[k] for k in contact]
    duration = settings["duration"]
    both = list(zip(parameters, restitution, strict=True))
    return pd.DataFrame(
        {
            **axes,
            "mean_velocity": [rigid_part_motion.run(row, duration, e).mean_velocity for row, e in both],
            "state": [state_of(row, e, cycles) for row, e in both],
        }
    )


def doubling(conveyor: Conveyor, restitution, period: int, low: float, settings: dict) -> float:
    """Amplitude (m/s²) beyond `low` at which the period of the rigid part's jumps grows beyond `period`.

    Steps of `settings["margin"]` find the first amplitude without that period, bisection where it ends.
    """

    def repeats(acceleration: float) -> bool:
        row = pack(conveyor, Start(settings["z0"]))
        row[ACCELERATION] = acceleration
        times = times_of_periods(row, settings["duration"], period)
        height = rigid_part_motion.sample(row, times, restitution)["z"]
        return period_of(height, (period,), settings["close"]) > 0

    low += settings["margin"]
    high = low
    while repeats(high):
        low, high = high, high + settings["margin"]
    while high - low > settings["resolution"]:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if repeats(middle) else (low, middle)
    return 0.5 * (low + high)


def orbit_of(conveyor: Conveyor, restitution: tuple[np.ndarray, np.ndarray]) -> RigidOrbit:
    """The orbit with one impact in a cycle, from a table of restitution."""
    return rigid_orbit(conveyor, lambda speed: float(np.interp(speed, *restitution)))


def bifurcation_rows(model: str, conveyor: Conveyor, restitution, settings: dict) -> list[dict]:
    """The fold and the first period doublings of the jumps of a rigid part."""
    orbit = orbit_of(conveyor, restitution)
    rows = [bifurcation(model, "fold", 1, orbit.fold), bifurcation(model, "period doubling", 1, orbit.doubling)]
    low = orbit.doubling
    for number in range(2, settings["doublings"] + 1):
        low = doubling(conveyor, restitution, 2 ** (number - 1), low, settings)
        rows.append(bifurcation(model, "period doubling", number, low))
    return rows


def bifurcation(model: str, kind: str, number: int, acceleration: float) -> dict:
    return {
        "model": model,
        "kind": kind,
        "number": number,
        "acceleration": acceleration,
        "z0": math.nan,
        "mean_velocity": math.nan,
        "state": None,
    }


def make(
    settings: dict,
    entry: dict,
    sweeps: pd.DataFrame,
    folds_and_doublings: pd.DataFrame,
    cascade: pd.DataFrame,
    *,
    progress: str | None = None,
) -> dict[str, np.ndarray]:
    """The columns of the table of the rigid part.

    Parameters
    ----------
    settings : the section `rigid_part` of the config
    entry : settings of the sweep
    sweeps, folds_and_doublings, cascade : tables of the compliant contact
    """
    conveyor, _ = grid.conveyor_and_start(entry["model"])
    of_speed = table_of_restitution(pack(conveyor, Start()))
    one_number = SPEEDS, np.full(len(SPEEDS), orbit_of(conveyor, of_speed).restitution)

    rows = []
    heights = sweeps.z0.agg(["min", "max"])
    starts = sweeps[sweeps.z0.isin(heights)]
    axes = {"z0": list(heights), "acceleration": list(starts.acceleration.unique())}
    rigid = swept({**entry, "axes": axes})
    for model, table in ((CONTACT, starts), (RIGID, rigid)):
        found = table[["acceleration", "z0", "mean_velocity", "state"]].assign(model=model, kind="velocity", number=0)
        rows += found.to_dict("records")

    folds = folds_and_doublings.query("kind == 'fold' and period == 1 and longest_flight > 0.5")
    rows.append(bifurcation(CONTACT, "fold", 1, float(folds.acceleration.min())))
    doublings = cascade.sort_values("number").head(settings["doublings"])
    rows += [
        bifurcation(CONTACT, "period doubling", int(row.number), float(row.acceleration))
        for row in doublings.itertuples()
    ]
    models = {RIGID: of_speed, ONE_NUMBER: one_number}
    for model, restitution in bar(models.items(), label=progress, unit="models"):
        rows += bifurcation_rows(model, conveyor, restitution, settings)
    return fields.columns(rows, TABLES["rigid_part"])
