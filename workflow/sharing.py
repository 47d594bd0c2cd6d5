"""How a sweep is shared between jobs: what it costs, estimated from its entry of the config, and the rows of a job.

The estimate is coarse: it knows no tolerances, no settled motions that are not computed again, no more of chaos than
whether the plate can throw parts (docs/cluster.md compares it with what jobs took). It decides how a sweep is cut, what
jobs ask a cluster for, and what is refused; no number of a table depends on it.
"""

import math
from typing import NamedTuple

from workflow.config_types import constants
from workflow.tables_of_config import count_points, count_values, ends, resolve, values_of

THREADS = 2  # of a job
STARTS = ("psi0", "z0", "vz0")  # what belongs to a start; all other parameters are those of its conveyor
CHAOS_SHARED = constants("pipeline/motions.py", "CHAOS_SHARED")["CHAOS_SHARED"]
ROW_GROUP = constants("pipeline/tables.py", "ROW_GROUP")["ROW_GROUP"]


class Plan(NamedTuple):
    """How a sweep is shared, and what is expected of each job; the last shard may be smaller."""

    points: int
    rows: int  # of a shard
    shards: int
    seconds: float  # of a shard on one core
    memory: float  # MB, of a shard
    gathering: float  # MB, of the job that puts the shards together

    @property
    def core_hours(self) -> float:
        return self.shards * self.seconds / 3600.0


def restless(entry: dict) -> float:
    """The share of conveyors whose plate can throw a part that rests on it: there chaos is found often."""
    lift = math.sin(max(values_of(entry, "angle")))
    limit = min(values_of(entry, "gravity")) / lift if lift > 0.0 else math.inf
    axis = entry["axes"].get("acceleration", [entry["model"].get("acceleration")])
    if isinstance(axis, list):
        return sum(value > limit for value in axis) / len(axis)
    low, high = ends(axis)
    return min(max((high - limit) / (high - low), 0.0), 1.0) if low < high else float(low > limit)


def conveyors_of(axes: dict, rows: int) -> int:
    """How many conveyors some consecutive rows of a product of axes have, the first axis the slowest."""
    found, stride = 1, math.prod(map(count_values, axes.values()))
    for name, axis in axes.items():
        stride //= count_values(axis)
        if name not in STARTS:
            found *= min(count_values(axis), math.ceil(rows / stride))
    return found


def seconds_of(entry: dict, costs: dict, rows: int) -> float:
    """What consecutive rows of a resolved entry take on one core, estimated from measured `costs` (s)."""
    if "step" in entry:
        run = costs["fixed_step"] * entry["duration"] / entry["step"]
    else:
        frequencies = values_of(entry, "frequency")
        run = costs["cycle"] * entry["duration"] * sum(frequencies) / len(frequencies)
    share = restless(entry)
    starts = math.prod(count_values(axis) for name, axis in entry["axes"].items() if name in STARTS)
    if starts < CHAOS_SHARED:
        return rows * (run + costs["start"] + share * costs["restless_start"])
    sets = costs["quiet_conveyor"] + share * costs["restless_conveyor"]
    return rows * (run + costs["start"]) + conveyors_of(entry["axes"], rows) * sets


def most_rows(entry: dict, costs: dict, seconds: float) -> int:
    """The most rows of a resolved entry that take at most some seconds on one core; at least one."""
    low, high = 1, count_points(entry["axes"])
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if seconds_of(entry, costs, middle) <= seconds else (low, middle - 1)
    return low


def plan(config: dict, name: str) -> Plan:
    """How the sweep `name` is shared: jobs of the wanted time and memory, unless they were too many."""
    sharing, entry = config["sharing"], resolve(config, "sweeps", name)
    costs, memory = sharing["seconds"], sharing["megabytes"]
    points = count_points(entry["axes"])
    rows = min(
        most_rows(entry, costs, THREADS * sharing["job_seconds"]),
        max(1, int((sharing["job_megabytes"] - memory["program"]) / memory["row"])),
    )
    rows = min(points, max(rows, math.ceil(points / sharing["most_jobs"])))
    return Plan(
        points,
        rows,
        math.ceil(points / rows),
        seconds_of(entry, costs, rows),
        memory["program"] + rows * memory["row"],
        memory["program"] + min(points, rows + ROW_GROUP) * memory["gathered_row"],
    )
