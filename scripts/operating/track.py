"""The velocity of each regular state over the inclination of the track and the phase shift of the drive.

The motion normal to the track depends on the inclination, through g cos α, and not on the phase shift. Therefore each
state is settled once per inclination; for each phase shift, only the feeding motion is followed from there.

On average over a period, the contact force is m g cos α. Where |tan α| exceeds the friction coefficient, friction
cannot hold a part in any periodic motion: it slides downhill faster and faster, and has no mean velocity.
"""

import numpy as np

from conveyor import ensemble
from conveyor.solver.model import FREQUENCY, PHASE_SHIFT
from operating.regimes import SLIDES_AWAY
from operating.shares import FORGOTTEN, continue_normal, parameters_of, starts_of_box
from pipeline import fields, grid
from pipeline.motions import motions_of_starts

STATES = ("first", "second")
TABLES = {
    "track": (
        fields.number("inclination", "rad", "inclination of the track"),
        fields.number("phase_shift", "rad", "phase by which the motion along the track leads"),
        *fields.STATE,
        fields.number("mean_velocity", "m/s", "mean feeding velocity; null where there is none"),
        fields.text("status", f"ok, no start settles to the state, or {SLIDES_AWAY}"),
    )
}


def settled_rows(inclinations: np.ndarray, settings: dict, threads: int) -> list[tuple[int, str, int, np.ndarray]]:
    """Number of the inclination, state, period and packed parameters, shape (16,), of each settled motion."""
    starts, amplitude = starts_of_box(settings), np.array([settings["acceleration"]])
    models = [{**settings["model"], "inclination": value} for value in inclinations]
    rows = np.concatenate([parameters_of(amplitude, starts, model) for model in models])
    found = motions_of_starts(rows, settings, starts=len(starts), threads=threads)
    motions = []
    for number in range(len(inclinations)):
        own = np.arange(number * len(starts), (number + 1) * len(starts))
        for state in STATES:
            # The most frequent period, of which the trajectory that settles first.
            members = own[(found.state[own] == state) & (found.period[own] > 0)]
            if len(members):
                period = np.bincount(found.period[members]).argmax()
                members = members[found.period[members] == period]
                motions.append((number, state, int(period), members[found.cycles[members].argmin()]))
    places = np.array([place for *_, place in motions], dtype=np.int64)
    settled = continue_normal(rows[places], found.cycles[places] + FORGOTTEN, settings, threads=threads)
    return [(*motion, row) for (*motion, _), row in zip(motions, settled, strict=True)]


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table: a row for each state at each inclination and phase shift."""
    inclinations, shifts = (grid.axis_values(name, settings[name]) for name in ("inclination", "phase_shift"))
    motions = settled_rows(inclinations, settings, threads)
    shape = (len(inclinations), len(STATES), len(shifts))
    velocity, period = np.full(shape, np.nan), np.zeros(shape, dtype=np.int64)
    for cycles in sorted({motion_period for _, _, motion_period, _ in motions}):
        chosen = [(number, STATES.index(state), row) for number, state, own, row in motions if own == cycles]
        rows = np.repeat([row for *_, row in chosen], len(shifts), axis=0)
        rows[:, PHASE_SHIFT] = np.tile(shifts, len(chosen))
        # The last quarter of the run holds whole periods.
        duration = 4.0 * cycles * np.ceil(settings["cycles"] / (4.0 * cycles)) / rows[0, FREQUENCY]
        label = progress and f"{progress}, period {cycles}"
        run = ensemble.run(rows, duration=duration, tolerance=settings["tolerance"], threads=threads, progress=label)
        for (number, state, _), means in zip(chosen, run["mean_velocity"].reshape(len(chosen), -1), strict=True):
            velocity[number, state], period[number, state] = means, cycles
    model, status = settings["model"], np.where(period > 0, "ok", "no start settles to the state").astype(object)
    steep = np.abs(np.tan(inclinations)) > model.get("static_friction", model["friction"])
    velocity[steep], status[steep] = np.nan, SLIDES_AWAY
    alpha, state, shift = np.indices(shape)
    return {
        "inclination": inclinations[alpha.ravel()],
        "phase_shift": shifts[shift.ravel()],
        "state": np.array(STATES)[state.ravel()],
        "period": period.ravel(),
        "mean_velocity": velocity.ravel(),
        "status": status.ravel(),
    }
