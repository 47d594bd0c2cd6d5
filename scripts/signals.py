"""Rule signals: the motion of a few parts, and of their conveyors, over time."""

import numpy as np

from conveyor import grid, tables
from conveyor.model import conveyor_motion, unpack
from conveyor.simulation import Run, simulate
from motions import motions_after
from rule_log import logged


def motion(run: Run, times: np.ndarray) -> dict[str, np.ndarray]:
    """The motion of one part and of its plate at `times` (s)."""
    plate = {f"plate_{name}": values for name, values in conveyor_motion(run.conveyor, times).items()}
    return {"time": times, **run.sample(times), **plate}


def columns(settings: dict) -> dict[str, np.ndarray]:
    """The columns of a table of signals for the resolved `settings` of an entry of the config."""
    options = {name: settings[name] for name in ("duration", "method", "tolerance", "step") if name in settings}
    times = np.linspace(settings["times"]["start"], settings["times"]["stop"], int(settings["times"]["num"]))
    axes, parameters = grid.product(settings["axes"], settings["model"])
    runs = [simulate(*unpack(row), **options) for row in parameters]
    ends = np.array([(run.z_end, run.vz_end) for run in runs]).T
    found = motions_after(parameters, *ends, settings)
    labels = {**axes, "state": found.state, "period": found.period}
    motions = [motion(run, times) for run in runs]
    repeated = {name: np.repeat(values, len(times)) for name, values in labels.items()}
    return repeated | {name: np.concatenate([one[name] for one in motions]) for name in motions[0]}


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        settings = snakemake.params.settings
        tables.write(snakemake.output[0], "signals", columns(settings), axes=list(settings["axes"]), settings=settings)
