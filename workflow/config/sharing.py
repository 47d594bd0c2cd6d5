"""Division of a sweep into jobs: the estimated cost of its rows, and the number of rows per job.

The estimate is coarse: it ignores tolerances and cached motions, and predicts chaos only from whether the plate can
throw parts. It decides the size of shards, the resources that jobs request, and which sweeps are rejected; no number of
a table depends on it.
"""

import math
from bisect import bisect_right
from typing import NamedTuple

from scripts.pipeline.sizes import BLOCK, CHAOS_SHARED, CYCLES_SHARED, ORBITS_SHARED, ROW_GROUP
from scripts.pipeline.table_settings import INITIAL_CONDITION

from .entries import count_points, count_values, ends, values_of

THREADS = 2  # of a job
MOST_JOBS = 500  # of a sweep; jobs of a larger sweep take longer, because Snakemake is slow with thousands of jobs
# Processor times of one core (s), measured at nine amplitudes from 30 to 90 m/s² and tolerances from 1e-6 to 3e-10:
# of one excitation cycle by the method event, and of one step of a fixed-step method.
CYCLE, FIXED_STEP = 4.5e-6, 3.5e-9
# Processor times (s) per initial condition, and per conveyor, by what is computed first for it: nothing (alone),
# its chaotic sets (chaos), or these and its periodic orbits (orbits). The first number of a pair holds if the plate
# cannot throw a part at rest, the second if it can.
START = {"alone": (1.5e-4, 6.0e-2), "chaos": (4.5e-5, 1.0e-4), "orbits": (1.0e-5, 8.0e-5)}
CONVEYOR = {"alone": (0.0, 0.0), "chaos": (4.0e-3, 0.2), "orbits": (3.0e-2, 0.21)}
# Memory (MB) of every job, per row in computation, and per row in writing.
PROGRAM, ROW, WRITTEN_ROW = 280.0, 9.0e-4, 2.5e-4


class Plan(NamedTuple):
    """The division of a sweep, and the expected cost of a job; the last shard may be smaller."""

    points: int
    rows: int  # of a shard
    shards: int
    seconds: float  # of a shard on one core
    memory: float  # MB, of a shard
    gathering: float  # MB, of the job that joins the shards

    @property
    def core_hours(self) -> float:
        return self.shards * self.seconds / 3600.0


def throwing_share(entry: dict) -> float:
    """The share of conveyors whose plate can throw a part that rests on it, where chaos is frequent."""
    lift = math.sin(max(values_of(entry, "angle")))
    normal = min(values_of(entry, "gravity")) * math.cos(max(map(abs, values_of(entry, "inclination"))))
    limit = normal / lift if lift > 0.0 else math.inf
    axis = entry["axes"].get("acceleration", [entry["model"].get("acceleration")])
    if isinstance(axis, list):
        return sum(value > limit for value in axis) / len(axis)
    low, high = ends(axis)
    return min(max((high - limit) / (high - low), 0.0), 1.0) if low < high else float(low > limit)


def conveyors_of(axes: dict, rows: int) -> int:
    """Number of conveyors in consecutive rows of a product of axes, of which the first varies slowest."""
    conveyors, stride = min(rows, 1), math.prod(map(count_values, axes.values()))
    for name, axis in axes.items():
        stride //= count_values(axis)
        if name not in INITIAL_CONDITION:
            conveyors *= min(count_values(axis), math.ceil(rows / stride))
    return conveyors


def known_of(entry: dict) -> str:
    """Which attractors of each conveyor are computed before its initial conditions are followed."""
    starts = math.prod(count_values(axis) for name, axis in entry["axes"].items() if name in INITIAL_CONDITION)
    if starts < CHAOS_SHARED or starts * entry["settling"] < CYCLES_SHARED:
        return "alone"
    return "chaos" if starts < ORBITS_SHARED else "orbits"


def seconds_of(entry: dict, rows: int) -> float:
    """Estimated time of consecutive rows of a resolved entry on one core (s)."""
    if "step" in entry:
        run = FIXED_STEP * entry["duration"] / entry["step"]
    else:
        frequencies = values_of(entry, "frequency")
        run = CYCLE * entry["duration"] * sum(frequencies) / len(frequencies)
    known, share = known_of(entry), throwing_share(entry)
    start, conveyor = (quiet + share * (thrown - quiet) for quiet, thrown in (START[known], CONVEYOR[known]))
    blocks, rest = divmod(rows, BLOCK)
    conveyors = blocks * conveyors_of(entry["axes"], BLOCK) + conveyors_of(entry["axes"], rest)
    return rows * (run + start) + conveyors * conveyor


def plan(sharing: dict, entry: dict) -> Plan:
    """The division of a sweep into jobs of the requested duration, or of a longer one if there would be too many."""
    points = count_points(entry["axes"])
    # The largest number of rows that take at most this time.
    limit = THREADS * sharing["job_seconds"]
    rows = bisect_right(range(1, points + 1), limit, key=lambda rows: seconds_of(entry, rows))
    rows = max(1, rows, math.ceil(points / MOST_JOBS))
    computed, written = ROW * min(rows, BLOCK), WRITTEN_ROW * min(rows, ROW_GROUP + BLOCK)
    return Plan(
        points,
        rows,
        math.ceil(points / rows),
        seconds_of(entry, rows),
        PROGRAM + computed + written,
        PROGRAM + WRITTEN_ROW * min(points, 2 * ROW_GROUP),
    )
