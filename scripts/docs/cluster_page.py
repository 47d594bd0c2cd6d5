"""What large sweeps cost on a cluster, and what breaks first, from measured jobs."""

import math

import numpy as np
import pandas as pd
from jinja2 import Environment, StrictUndefined

HEAD = (
    "| Points | Jobs | Made | Points of a job | Computing, µs a point | Time of a job, s | Estimated, s "
    "| Memory of a job, MB | Core hours | Putting together, min | Its memory, MB | File, GB |\n"
    f"{12 * '|---'}|\n"
)


def costs(table: pd.DataFrame) -> pd.DataFrame:
    """What each sweep of the table takes as a whole: in proportion to its points where not all shards were made."""
    rows = table[table.varied == "points"].sort_values("points")
    seconds_of_row = (rows.gathering_seconds / rows.gathered).iloc[-1]
    return rows.assign(
        microseconds=1e6 * rows.computing_seconds / rows.computed,
        core_hours=rows.points / rows.computed * rows.shard_seconds * rows.threads / 3600.0,
        job_seconds=rows.shard_seconds / rows.measured,
        minutes=np.where(rows.gathered == rows.points, rows.gathering_seconds, rows.points * seconds_of_row) / 60.0,
        gigabytes=rows.points * rows.bytes / 1e9,
    )


def lines(rows: pd.DataFrame) -> str:
    return HEAD + "".join(
        f"| {row.points:,} | {row.shards} | {row.measured} | {row.rows:,} | {row.microseconds:.1f} "
        f"| {row.job_seconds:.0f} | {row.estimated_seconds:.0f} | {row.shard_memory:.0f} | {row.core_hours:.2g} "
        f"| {row.minutes:.2g} | {row.gathering_memory:.0f} | {row.gigabytes:.2g} |\n"
        for row in rows.itertuples()
    )


def numbers(table: pd.DataFrame, sharing: dict) -> dict[str, str | bool]:
    """All that the template asks for, in words.

    Parameters
    ----------
    table : of scaling
    sharing : the section of the config
    """
    rows = costs(table)
    largest = rows.iloc[-1]
    conveyors = table[table.varied == "conveyors"].sort_values("points").iloc[-1]
    long = table[table.computing_seconds > 1.0]
    ratio = long.estimated_seconds * long.computed / long.rows / long.computing_seconds
    one = table[(table.varied == "threads") & (table.threads == table.threads.min())].iloc[0]
    loading = table.loading_seconds.div(table.measured).median()
    start = table.shard_seconds.sub(table.computing_seconds).div(table.measured).median() - loading
    estimated_hours = largest.shards * largest.estimated_seconds * largest.threads / 3600.0
    return {
        "table": lines(rows),
        "points": f"{largest.points:,}",
        "jobs": f"{largest.shards}",
        "core_hours": f"{largest.core_hours:.2g}",
        "limit": f"{sharing['core_hours']:g}",
        "estimated_hours": f"{estimated_hours:.2g}",
        "within_limit": estimated_hours <= sharing["core_hours"],
        "wall_minutes": f"{math.ceil(largest.shards / 50) * largest.job_seconds / 60.0:.2g}",
        "gathering_minutes": f"{largest.minutes:.0f}",
        "gathering_memory": f"{largest.gathering_memory:.0f}",
        "gigabytes": f"{largest.gigabytes:.2g}",
        "most_memory": f"{max(table.shard_memory.max(), table.gathering_memory.max()):.0f}",
        "conveyors": f"{conveyors.points:,}",
        "conveyors_memory": f"{conveyors.shard_memory:.0f}",
        "least_ratio": f"{ratio.min():.2g}",
        "most_ratio": f"{ratio.max():.2g}",
        "microseconds": f"{1e6 * one.computing_seconds / one.computed:.0f}",
        "threads": f"{largest.threads}",
        "least_microseconds": f"{rows.microseconds.min():.1f}",
        "most_microseconds": f"{rows.microseconds.max():.1f}",
        "made_whole": f"{rows.points[rows.measured == rows.shards].max():,}",
        "start": f"{start:.1f}",
        "loading": f"{loading:.1f}",
        "most_jobs": f"{sharing['most_jobs']}",
        "job_seconds": f"{sharing['job_seconds']:g}",
    }


def make(scaling: pd.DataFrame, template: str, settings: dict) -> str:
    """The page from its template, the table of scaling and the section `sharing` of the config."""
    environment = Environment(undefined=StrictUndefined, keep_trailing_newline=True)
    return environment.from_string(template).render(numbers(scaling, settings))
