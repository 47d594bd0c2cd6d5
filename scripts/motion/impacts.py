"""The first impact of each start, and the states that the start and its image on the plate lead to."""

import numpy as np

from conveyor.analysis.basins.first_impact import first_impacts, on_conveyor
from pipeline import fields, grid
from pipeline.motions import motions

TABLES = {
    "impacts": (
        fields.number(
            "impact_time", "s", "time of the first impact (Eq. 16); null for a start below the plate's surface"
        ),
        fields.number("impact_velocity", "m/s", "vertical velocity of the part then (Eq. 17)"),
        fields.number("impact_phase", "rad", "phase of the excitation then (Eq. 18), not wrapped"),
        fields.text("state", "state of motion that the start leads to"),
        fields.text(
            "mapped_state", "state that a start on the plate with this phase and velocity leads to; null without impact"
        ),
    ),
}


def make(settings: dict, *, threads: int = 1) -> dict[str, np.ndarray]:
    """The columns of a table of impacts for the resolved `settings` of an entry of the config."""
    axes, parameters = grid.product(settings["axes"], settings["model"])
    impacts = first_impacts(parameters)
    mapped = np.isfinite(impacts.time)
    images = on_conveyor(parameters, impacts)[mapped]
    # Together: what the starts of a conveyor share is found once.
    states = motions(np.concatenate([parameters, images]), settings, threads=threads).state
    state, of_images = np.split(states, [len(parameters)])
    mapped_state = np.full(len(parameters), None, dtype=object)
    mapped_state[mapped] = of_images
    return {
        **axes,
        "impact_time": impacts.time,
        "impact_velocity": impacts.velocity,
        "impact_phase": impacts.phase,
        "state": state,
        "mapped_state": mapped_state,
    }
