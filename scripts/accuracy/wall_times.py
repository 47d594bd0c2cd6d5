"""Wall time of every run of a table of work and precision, the methods alternating.

Times differ from run to run and from machine to machine. They have a table of their own, so that what does not stays as
it is.
"""

from time import perf_counter

import numpy as np
import pandas as pd

from accuracy.precision import RUN, Method, follow
from conveyor.solver.progress import bar
from pipeline import fields

TABLES = {
    "wall_times": (
        *RUN,
        fields.number("seconds", "s", "median wall time"),
        fields.count("repeats", "timed runs"),
    ),
}

# A turn of a fast method is repeated for this long, so that what ran before it leaves no trace in the median.
TURN = 0.01  # s


def make(precision: pd.DataFrame, settings: dict, *, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of a table of times for a table of work and precision.

    In each of `repeats` rounds every run gets a turn, unless `seconds` are spent on it. What has to be compiled is
    compiled before the first one.
    """
    listed = [
        Method(row.method, row.treatment, *(None if np.isnan(value) else value for value in (row.tolerance, row.step)))
        for row in precision.itertuples()
    ]
    scene = precision.attrs
    times: list[list[float]] = [[] for _ in listed]
    for method in listed:
        follow(method, scene | {"max_evaluations": 1000, "duration": 1e-3})
    for _ in bar(range(settings["repeats"]), label=progress, unit="rounds"):
        for method, spent in zip(listed, times, strict=True):
            turn_ends = perf_counter() + TURN
            while sum(spent) < settings["seconds"]:
                begin = perf_counter()
                follow(method, scene)
                end = perf_counter()
                spent.append(end - begin)
                if end > turn_ends:
                    break
    return {
        **{name: precision[name].to_numpy() for name in Method._fields},
        "seconds": np.array([np.median(spent) for spent in times]),
        "repeats": np.array([len(spent) for spent in times]),
    }
