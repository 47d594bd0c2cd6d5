"""Comparison of the compliant contact with a rigid bouncing part.

Velocities and states of motion over the amplitude by both models, and the amplitudes of the fold and of the period
doublings of the jumping motion. The rigid part has a coefficient of restitution that depends on the speed of approach
as in the contact, or a constant one.
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from conveyor import LONG_FLIGHT, MAX_PERIOD, Conveyor, Start, parameter_table, progress_bar
from conveyor.methods import rigid_part_motion
from conveyor.methods.restitution import restitution_coefficients
from conveyor.methods.rigid_part_orbits import RigidOrbit, rigid_orbit
from pipeline import fields, grid

TABLES = {
    "rigid_part": (
        fields.text("model", "contact, or a rigid part whose restitution is e(u) or constant"),
        fields.text("kind", "velocity, fold or period doubling"),
        fields.count("number", "number of the bifurcation in ascending order; 0 for velocities"),
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.number("z0", "m", "initial height; null for bifurcations"),
        fields.number("mean_velocity", "m/s", "mean feeding velocity over the last quarter; null for bifurcations"),
        fields.text("state", "first, second, chaos or undecided; null for bifurcations"),
    ),
}

SPEEDS = np.geomspace(1e-3, 1.0, 64)  # m/s, speeds of approach of the table of restitution
LAST_CYCLE = 50  # samples of the last cycle, for the height of a jump
# Largest distance from an earlier state, in heights of a jump, that counts as a return: of a sweep, and at a doubling.
CLOSE, CLOSE_AT_DOUBLING = 1e-2, 1e-3
START = Start(0.3e-3)  # the jumping part of Fig. 4
DURATION = 40.0  # s, within which a motion must repeat itself
MARGIN = 0.05  # m/s², steps of the amplitude in which a period is followed
RESOLUTION = 1e-4  # m/s², to which bisection locates a doubling
DOUBLINGS = 3  # first period doublings that are compared
CYCLES = 2000  # simulated cycles, after which a motion without a period is undecided
# Parameters that determine the restitution.
CONTACT_PARAMETERS = ["stiffness", "damping", "mass", "exponent", "tension"]
CONTACT, RIGID, ONE_NUMBER = "contact", "rigid part, e(u)", "rigid part, one e"


def tabulate_restitution(parameters: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Speeds of approach (m/s) and coefficients of restitution of the contact of a parameter vector, shape (16,)."""
    return SPEEDS, restitution_coefficients(parameters, SPEEDS)


def find_state(row: np.ndarray, restitution: tuple[np.ndarray, np.ndarray], cycles: int) -> str:
    """State of motion of a rigid part after some cycles, from its last flights and its period.

    A motion without a period is `undecided`, because the exponents of a rigid part are not computed.
    """
    duration, cycle = cycles / row["frequency"], 1.0 / row["frequency"]
    times = sample_times(row, duration, MAX_PERIOD)
    samples, hits = rigid_part_motion.samples_and_impacts(row, times, restitution)
    flights = hits["flight"][hits["time"] > duration - 2.0 * MAX_PERIOD * cycle]
    if len(flights) == 0 or flights.max() < LONG_FLIGHT * cycle:
        return "first"
    return "second" if find_period(samples["z"], range(1, MAX_PERIOD + 1)) else "undecided"


def sample_times(row: np.ndarray, duration: float, longest: int) -> np.ndarray:
    """Times (s) of the samples for `find_period`: strobes over twice the `longest` period, then the last cycle."""
    cycles = np.concatenate([np.arange(2 * longest), np.linspace(0.0, 1.0, LAST_CYCLE)])
    return duration - cycles / row["frequency"]


def find_period(height: np.ndarray, periods: Sequence[int], close: float = CLOSE) -> int:
    """The first of some periods (cycles) with which a rigid part repeats itself at the end of a run; 0 for none.

    height : m, at the `sample_times` for the longest period
    """
    strobed, jump = height[:-LAST_CYCLE], np.ptp(height[-LAST_CYCLE:])
    for period in periods:
        if np.abs(strobed[period:] - strobed[:-period]).max() < close * jump:
            return period
    return 0


def sweep(settings: dict, cycles: int = CYCLES) -> pd.DataFrame:
    """Mean velocities (m/s) of rigid parts and states of motion after some cycles, for the settings of a sweep."""
    axes, parameters = grid.product(settings["axes"], settings["model"])
    # Rows with the same contact share a table of restitution.
    _, first, contact = np.unique(parameters[CONTACT_PARAMETERS], return_index=True, return_inverse=True)
    contact_tables = [tabulate_restitution(row) for row in parameters[first]]
    restitution = [contact_tables[k] for k in contact]
    duration = settings["duration"]
    both = list(zip(parameters, restitution, strict=True))
    return pd.DataFrame(
        {
            **axes,
            "mean_velocity": [rigid_part_motion.run(row, duration, e).mean_velocity for row, e in both],
            "state": [find_state(row, e, cycles) for row, e in both],
        }
    )


def find_doubling(conveyor: Conveyor, restitution, period: int, low: float) -> float:
    """Amplitude (m/s²) above `low` at which the jumping motion of a rigid part no longer has the period `period`.

    A scan with steps of MARGIN brackets the amplitude, and bisection locates it.
    """

    def repeats(acceleration: float) -> bool:
        row = parameter_table(conveyor, START, acceleration=acceleration)
        times = sample_times(row, DURATION, period)
        height = rigid_part_motion.sample(row, times, restitution)["z"]
        return find_period(height, (period,), CLOSE_AT_DOUBLING) > 0

    low += MARGIN
    high = low
    while repeats(high):
        low, high = high, high + MARGIN
    while high - low > RESOLUTION:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if repeats(middle) else (low, middle)
    return 0.5 * (low + high)


def find_orbit(conveyor: Conveyor, restitution: tuple[np.ndarray, np.ndarray]) -> RigidOrbit:
    """The orbit with one impact per cycle, for a table of restitution."""
    return rigid_orbit(conveyor, lambda speed: float(np.interp(speed, *restitution)))


def bifurcation_rows(model: str, conveyor: Conveyor, restitution) -> list[dict]:
    """The rows of the fold and the first period doublings of the jumping motion of a rigid part."""
    orbit = find_orbit(conveyor, restitution)
    rows = [bifurcation_row(model, "fold", 1, orbit.fold), bifurcation_row(model, "period doubling", 1, orbit.doubling)]
    low = orbit.doubling
    for number in range(2, DOUBLINGS + 1):
        low = find_doubling(conveyor, restitution, 2 ** (number - 1), low)
        rows.append(bifurcation_row(model, "period doubling", number, low))
    return rows


def bifurcation_row(model: str, kind: str, number: int, acceleration: float) -> dict:
    """The row of a bifurcation at an amplitude (m/s²)."""
    return {"model": model, "kind": kind, "number": number, "acceleration": acceleration}


def make(
    amplitudes: pd.DataFrame,
    folds_and_doublings: pd.DataFrame,
    cascade: pd.DataFrame,
    *,
    progress: str | None = None,
) -> dict[str, np.ndarray]:
    """The columns of the table of the rigid part, from the tables of the compliant contact."""
    conveyor, _ = grid.conveyor_and_start(amplitudes.attrs["model"])
    speed_dependent = tabulate_restitution(parameter_table(conveyor))
    constant = SPEEDS, np.full(len(SPEEDS), find_orbit(conveyor, speed_dependent).restitution)

    rows = []
    heights = amplitudes.z0.agg(["min", "max"])
    compliant = amplitudes[amplitudes.z0.isin(heights)]
    axes = {"z0": list(heights), "acceleration": list(compliant.acceleration.unique())}
    rigid = sweep({**amplitudes.attrs, "axes": axes})
    for model, table in ((CONTACT, compliant), (RIGID, rigid)):
        found = table[["acceleration", "z0", "mean_velocity", "state"]].assign(model=model, kind="velocity", number=0)
        rows += found.to_dict("records")

    folds = folds_and_doublings.query("kind == 'fold' and period == 1 and longest_flight > 0.5")
    rows.append(bifurcation_row(CONTACT, "fold", 1, float(folds.acceleration.min())))
    doublings = cascade.sort_values("number", kind="stable").head(DOUBLINGS)
    rows += [
        bifurcation_row(CONTACT, "period doubling", int(row.number), float(row.acceleration))
        for row in doublings.itertuples()
    ]
    models = {RIGID: speed_dependent, ONE_NUMBER: constant}
    for model, restitution in progress_bar(models.items(), label=progress, unit="models"):
        rows += bifurcation_rows(model, conveyor, restitution)
    # Columns of velocities only are null for bifurcations.
    return pd.DataFrame(rows, columns=[column.name for column in TABLES["rigid_part"]]).to_dict("list")
