"""The first impact of each initial condition, and the states that both lead to."""

import numpy as np

from conveyor.analysis.basins.first_impact import first_impacts, on_conveyor
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.common.labelling import label_entry

TABLES = {
    "impacts": (
        fields.number("impact_time", "s", "time of the first impact (Eq. 16); null for a start below the plate"),
        fields.number("impact_velocity", "m/s", "vertical velocity of the part at the impact (Eq. 17)"),
        fields.number("impact_phase", "rad", "phase of the excitation at the impact (Eq. 18), not wrapped"),
        fields.text("state", "state of motion that the initial condition leads to"),
        fields.text("mapped_state", "state of a part that starts at this phase and velocity; null without impact"),
    ),
}


def make(settings: dict, *, threads: int = 1) -> dict[str, np.ndarray]:
    """The columns of a table of impacts for the resolved `settings` of an entry of the config."""
    axes, parameters = grid.product(settings["axes"], settings["model"])
    impacts = first_impacts(parameters)
    mapped = np.isfinite(impacts.time)
    images = on_conveyor(parameters, impacts)[mapped]
    # One call, because the initial conditions of a conveyor share the search for its attractors.
    states = label_entry(np.concatenate([parameters, images]), settings, threads=threads).state
    state, image_states = np.split(states, [len(parameters)])
    mapped_state = np.full(len(parameters), None, dtype=object)
    mapped_state[mapped] = image_states
    return {
        **axes,
        "impact_time": impacts.time,
        "impact_velocity": impacts.velocity,
        "impact_phase": impacts.phase,
        "state": state,
        "mapped_state": mapped_state,
    }
