"""The velocity of each regular state over the inclination of the track and the phase shift of the drive.

The motion normal to the track depends on the inclination, through g cos α, and not on the phase shift. Therefore each
state is computed once per inclination; for each phase shift, only the feeding motion is followed from there.

Where the track is too steep for friction, a part slides downhill faster and faster, and has no mean velocity.
"""

import numpy as np

from conveyor import sweep
from conveyor.packing import plate_peaks
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.common.labelling import label_starts
from conveyor_pipeline.common.steepness import fill_in, steepness
from conveyor_pipeline.machine.operating.parts import population
from conveyor_pipeline.machine.operating.populations import IDENTICAL
from conveyor_pipeline.machine.operating.regimes import NOT_ALL_SETTLED, SLIDES_AWAY
from conveyor_pipeline.machine.operating.shares import FORGOTTEN, SETTLED, brief_durations, continue_normal

STATES = ("first", "second")
NOT_REACHED = "no initial condition leads to the state"
CYCLES = 60  # excitation cycles; the transient of the feeding velocity decays within about ten
TABLES = {
    "track": (
        fields.number("inclination", "rad", "inclination of the track"),
        fields.number("phase_shift", "rad", "phase by which the motion along the track leads"),
        *fields.STATE,
        fields.number("mean_velocity", "m/s", "mean feeding velocity; null where there is none"),
        fields.text("status", f"ok, {NOT_REACHED}, {NOT_ALL_SETTLED}, or {SLIDES_AWAY}"),
    )
}


def settled_motions(
    inclinations: np.ndarray, settings: dict, threads: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Number of the inclination, number of the state and period of each settled motion, shape (k,), its
    parameters, shape (k,), and whether a search ended before it had settled, for each inclination.
    """
    starts = settings["starts"]
    amplitude = np.array([settings["acceleration"]])
    models = [{**settings["model"], "inclination": value} for value in inclinations]
    rows = np.concatenate([population(amplitude, {**settings, "model": model}, IDENTICAL) for model in models])
    labels = label_starts(rows, settings, starts=starts, threads=threads)
    motions = []
    for number in range(len(inclinations)):
        row_numbers = np.arange(number * starts, (number + 1) * starts)
        for place, state in enumerate(STATES):
            # The trajectory with the most frequent period that settles first.
            members = row_numbers[(labels.state[row_numbers] == state) & (labels.period[row_numbers] > 0)]
            if len(members):
                period = np.bincount(labels.period[members]).argmax()
                members = members[labels.period[members] == period]
                motions.append((number, place, period, members[labels.cycles[members].argmin()]))
    number, state, period, first = np.array(motions, dtype=np.int64).reshape(len(motions), 4).T
    settled = continue_normal(rows[first], labels.cycles[first] + FORGOTTEN, settings, threads=threads)
    is_open = ((labels.period == 0) & (labels.state != "chaos")).reshape(len(inclinations), starts).any(axis=1)
    return number, state, period, settled, is_open


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table: a row for each state at each inclination and phase shift."""
    inclinations, shifts = (grid.axis_values(name, settings[name]) for name in ("inclination", "phase_shift"))
    number, state, of_motion, settled, is_open = settled_motions(inclinations, settings, threads)
    rows = np.repeat(settled, len(shifts))
    rows["phase_shift"] = np.tile(shifts, len(settled))
    durations = brief_durations(rows, np.repeat(of_motion, len(shifts)), CYCLES)
    options = {"tolerance": settings["tolerance"], "threads": threads, "progress": progress}
    run = sweep(rows, duration=durations, **options)
    shape = (len(inclinations), len(STATES), len(shifts))
    velocity, period = np.full(shape, np.nan), np.zeros(shape, dtype=np.int64)
    velocity[number, state] = run["mean_velocity"].reshape(len(settled), len(shifts))
    period[number, state] = of_motion[:, None]
    missing = np.where(is_open, NOT_ALL_SETTLED, NOT_REACHED)[:, None, None]
    status = np.where(period > 0, "ok", missing).astype(object)
    slides = steepness(fill_in(settings["model"]) | {"inclination": inclinations}) == 2
    away = np.repeat(slides, len(STATES) * len(shifts)).reshape(shape)
    # Where only static friction holds a part, its velocity may not settle.
    doubtful = np.flatnonzero(steepness(rows) == 1)
    longer = sweep(rows[doubtful], duration=2.0 * durations[doubtful], **options)["mean_velocity"]
    unsettled = np.zeros(len(rows), dtype=bool)
    unsettled[doubtful] = np.abs(longer - run["mean_velocity"][doubtful]) > SETTLED * plate_peaks(rows[doubtful]).vx
    away[number, state] |= unsettled.reshape(len(settled), len(shifts))
    velocity[away], status[away] = np.nan, SLIDES_AWAY
    alpha, state, shift = np.indices(shape)
    return {
        "inclination": inclinations[alpha.ravel()],
        "phase_shift": shifts[shift.ravel()],
        "state": np.array(STATES)[state.ravel()],
        "period": period.ravel(),
        "mean_velocity": velocity.ravel(),
        "status": status.ravel(),
    }
