"""Runs of single parts and their states of motion, for all points of an entry of the config."""

import numpy as np

from conveyor import Columns, Run, conveyor_and_start, simulate
from conveyor_pipeline.common import grid
from conveyor_pipeline.common.labelling import label_ends


def simulate_entry(settings: dict, threads: int = 1) -> tuple[dict[str, np.ndarray], list[Run], Columns]:
    """Axes, runs and states of motion of all points of an entry of the config."""
    options = {name: settings[name] for name in ("duration", "method", "tolerance", "step") if name in settings}
    axes, parameters = grid.product(settings["axes"], settings["model"])
    runs = [simulate(*conveyor_and_start(row), **options) for row in parameters]
    ends = np.array([(run.z_end, run.vz_end) for run in runs]).T
    return axes, runs, label_ends(parameters, *ends, settings, threads=threads)
