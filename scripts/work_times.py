"""Rule work_times: wall time of every run of a table of work and precision, the methods alternating.

Times differ from run to run and from machine to machine. They have a table of their own, so that what does not stays as
it is.
"""

import sys
from time import perf_counter

import numpy as np
import pandas as pd
from tqdm import tqdm

from conveyor import tables
from rule_log import logged
from work import Method, follow

SHORT = 0.01  # s


def timed(method: Method, scene: dict) -> float:
    """Wall time (s) of a run; of the fastest of five where it is so short that a cold cache would count."""
    times = []
    while not times or (times[0] < SHORT and len(times) < 5):
        begin = perf_counter()
        follow(method, scene)
        times.append(perf_counter() - begin)
    return min(times)


def columns(precision: pd.DataFrame, settings: dict, *, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of a table of times for a table of work and precision.

    In each round every run gets its turn, until it has had `repeats` of them or `seconds` are spent on it. The first
    round, which compiles, does not count.
    """
    listed = [
        Method(row.method, row.treatment, *(None if np.isnan(value) else value for value in (row.tolerance, row.step)))
        for row in precision.itertuples()
    ]
    scene = precision.attrs
    times: list[list[float]] = [[] for _ in listed]
    for method in dict.fromkeys(method._replace(tolerance=1e-2, step=method.step and 1e-3) for method in listed):
        follow(method, scene | {"duration": 1e-3})
    turns = tqdm(range(settings["repeats"]), desc=progress, unit="round", disable=progress is None, file=sys.stderr)
    for _ in turns:
        for method, spent in zip(listed, times, strict=True):
            if sum(spent) < settings["seconds"]:
                spent.append(timed(method, scene))
    return {
        **{name: precision[name].to_numpy() for name in Method._fields},
        "seconds": np.array([np.median(spent) for spent in times]),
        "repeats": np.array([len(spent) for spent in times]),
    }


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        settings = snakemake.params.settings
        precision = tables.read(snakemake.input[0], "work")
        found = columns(precision, settings, progress=snakemake.wildcards.name)
        tables.write(snakemake.output[0], "work_times", found, settings=settings)
