"""Rule rigid_part: whether a rigid bouncing part would do in place of the contact.

Its velocity and state over the amplitude beside those of the contact, and the amplitudes of the fold and of the period
doublings of its jumps, with a coefficient of restitution that is one number and with one that depends on the speed of
approach as it does in the contact.
"""

import math
from collections.abc import Sequence

import numpy as np
import pandas as pd
from tqdm import tqdm

from conveyor import grid, rigid_ball, states, tables
from conveyor.model import (
    ACCELERATION,
    DAMPING,
    EXPONENT,
    MASS,
    STIFFNESS,
    TENSION,
    Conveyor,
    Start,
    pack,
    unpack,
)
from conveyor.rigid_orbit import RigidOrbit, rigid_orbit
from rule_log import logged

SPEEDS = np.geomspace(1e-3, 1.0, 64)  # m/s, of approach, at which the contact's restitution is tabulated
MAX_PERIOD = 64  # excitation cycles, of the motions that count as settled, as for the contact
CLOSE = 1e-2  # of the height of a jump: nearer than that, a motion has come back
CYCLES = 2000  # after which a rigid part has found its motion, or is called undecided
CONTACT_PARAMETERS = [STIFFNESS, DAMPING, MASS, EXPONENT, TENSION]  # on which restitution depends
CONTACT, RIGID, ONE_NUMBER = "contact", "rigid part, e(u)", "rigid part, one e"


def table_of_restitution(parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Speeds of approach (m/s) and coefficients of restitution of the contact in a parameter vector, shape (13,)."""
    return SPEEDS, rigid_ball.restitution_coefficients(parameters, SPEEDS)


def state_of(row: np.ndarray, restitution: tuple[np.ndarray, np.ndarray], cycles: int) -> str:
    """State of motion of a rigid part after some cycles: by its last flights, and by whether it repeats itself.

    What does not is `undecided`: chaos is a matter of exponents, which a rigid part has not been asked for.
    """
    conveyor, _ = unpack(row)
    duration, cycle = cycles / conveyor.frequency, 1.0 / conveyor.frequency
    hits = rigid_ball.impacts(row, duration, restitution)
    flights = np.diff(hits[hits["time"] > duration - 2.0 * MAX_PERIOD * cycle]["time"])
    if len(flights) == 0 or flights.max() < states.LONG_FLIGHT * cycle:
        return "first"
    return "second" if period_of(row, duration, restitution, range(1, MAX_PERIOD + 1)) else "undecided"


def period_of(row: np.ndarray, duration: float, restitution, periods: Sequence[int], close: float = CLOSE) -> int:
    """First of some periods (cycles) with which a rigid part repeats itself at the end of a run; 0 for none."""
    conveyor, _ = unpack(row)
    strobes = duration - np.arange(2 * max(periods)) / conveyor.frequency
    last_cycle = duration - np.linspace(0.0, 1.0, 50) / conveyor.frequency
    height = rigid_ball.sample(row, np.concatenate([strobes, last_cycle]), restitution)["z"]
    strobed, jump = height[: len(strobes)], np.ptp(height[len(strobes) :])
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
            "mean_velocity": [rigid_ball.run(row, duration, e).mean_velocity for row, e in both],
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
        return period_of(row, settings["duration"], restitution, (period,), settings["close"]) > 0

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


def columns(
    contact: dict[str, pd.DataFrame], sweep: dict, settings: dict, *, progress: str | None = None
) -> dict[str, np.ndarray]:
    """The columns of the table of the rigid part.

    Parameters
    ----------
    contact : tables of the compliant contact: sweep, bifurcations, cascade
    sweep : settings of that sweep
    settings : the section `rigid_part` of the config
    """
    _, parameters = grid.product({"acceleration": [0.0]}, sweep["model"])
    conveyor, _ = unpack(parameters[0])
    of_speed = table_of_restitution(parameters[0])
    one_number = SPEEDS, np.full(len(SPEEDS), orbit_of(conveyor, of_speed).restitution)

    rows = []
    heights = contact["sweep"].z0.agg(["min", "max"])
    starts = contact["sweep"][contact["sweep"].z0.isin(heights)]
    axes = {"z0": list(heights), "acceleration": list(starts.acceleration.unique())}
    rigid = swept({**sweep, "axes": axes})
    for model, table in ((CONTACT, starts), (RIGID, rigid)):
        found = table[["acceleration", "z0", "mean_velocity", "state"]].assign(model=model, kind="velocity", number=0)
        rows += found.to_dict("records")

    folds = contact["bifurcations"].query("kind == 'fold' and period == 1 and longest_flight > 0.5")
    rows.append(bifurcation(CONTACT, "fold", 1, float(folds.acceleration.min())))
    doublings = contact["cascade"].sort_values("number").head(settings["doublings"])
    rows += [
        bifurcation(CONTACT, "period doubling", int(row.number), float(row.acceleration))
        for row in doublings.itertuples()
    ]
    models = {RIGID: of_speed, ONE_NUMBER: one_number}
    for model, restitution in tqdm(models.items(), desc=progress, disable=progress is None):
        rows += bifurcation_rows(model, conveyor, restitution, settings)
    return {name: np.array([row[name] for row in rows]) for name in rows[-1]}


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        kinds = {"sweep": "sweeps", "bifurcations": "folds_and_doublings", "cascade": "cascade"}
        contact = {role: tables.read(snakemake.input[role], kind) for role, kind in kinds.items()}
        settings = snakemake.params.settings
        found = columns(contact, snakemake.params.sweep, settings, progress="rigid part")
        tables.write(snakemake.output[0], "rigid_part", found, settings=settings)
