"""Rule signals: the motion of a few parts, and of their conveyors, over time."""

import numpy as np

from conveyor import grid, tables
from conveyor.model import conveyor_motion, unpack
from conveyor.simulation import simulate
from rule_log import logged


def motion(parameters: np.ndarray, times: np.ndarray, options: dict) -> dict[str, np.ndarray]:
    """The motion of one part and of its plate at `times` (s), from its parameter vector, shape (13,)."""
    conveyor, start = unpack(parameters)
    part = simulate(conveyor, start, **options).sample(times)
    plate = {f"plate_{name}": values for name, values in conveyor_motion(conveyor, times).items()}
    return {"time": times, **part, **plate}


def columns(settings: dict) -> dict[str, np.ndarray]:
    """The columns of a table of signals for the resolved `settings` of an entry of the config."""
    options = {name: settings[name] for name in ("duration", "method", "tolerance", "step") if name in settings}
    times = np.linspace(settings["times"]["start"], settings["times"]["stop"], int(settings["times"]["num"]))
    axes, parameters = grid.product(settings["axes"], settings["model"])
    motions = [motion(row, times, options) for row in parameters]
    repeated = {name: np.repeat(values, len(times)) for name, values in axes.items()}
    return repeated | {name: np.concatenate([one[name] for one in motions]) for name in motions[0]}


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        settings = snakemake.params.settings
        tables.write(snakemake.output[0], "signals", columns(settings), axes=list(settings["axes"]), settings=settings)
