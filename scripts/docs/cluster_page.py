"""The page on the cost of large sweeps on a cluster, from measured jobs."""

import math

import numpy as np
import pandas as pd

from pipeline.templates import render


def total_costs(table: pd.DataFrame) -> pd.DataFrame:
    """The costs of each whole sweep, in proportion to its points if not all of its shards were computed."""
    rows = table[table.varied == "points"].sort_values("points")
    seconds_of_row = (rows.gathering_seconds / rows.gathered).iloc[-1]
    return rows.assign(
        microseconds=1e6 * rows.computing_seconds / rows.computed,
        core_hours=rows.points / rows.computed * rows.shard_seconds * rows.threads / 3600.0,
        job_seconds=rows.shard_seconds / rows.measured,
        minutes=np.where(rows.gathered == rows.points, rows.gathering_seconds, rows.points * seconds_of_row) / 60.0,
        gigabytes=rows.points * rows.bytes / 1e9,
    )


def sweep_row(row) -> list[str]:
    """The cells of a sweep in the table of the page."""
    return [
        f"{row.points:,}",
        f"{row.shards}",
        f"{row.measured}",
        f"{row.rows:,}",
        f"{row.microseconds:.1f}",
        f"{row.job_seconds:.0f}",
        f"{row.estimated_seconds:.0f}",
        f"{row.shard_memory:.0f}",
        f"{row.core_hours:.2g}",
        f"{row.minutes:.2g}",
        f"{row.gathering_memory:.0f}",
        f"{row.gigabytes:.2g}",
    ]


def values(table: pd.DataFrame, sharing: dict) -> dict[str, str | bool | list]:
    """The fields of the template.

    Parameters
    ----------
    table : the table `scaling`
    sharing : the section `sharing` of the config
    """
    rows = total_costs(table)
    largest = rows.iloc[-1]
    conveyors = table[table.varied == "conveyors"].sort_values("points").iloc[-1]
    long = table[table.computing_seconds > 1.0]
    ratio = long.estimated_seconds * long.computed / long.rows / long.computing_seconds
    one = table[(table.varied == "threads") & (table.threads == table.threads.min())].iloc[0]
    loading = table.loading_seconds.div(table.measured).median()
    start = table.shard_seconds.sub(table.computing_seconds).div(table.measured).median() - loading
    estimated_hours = largest.shards * largest.estimated_seconds * largest.threads / 3600.0
    return {
        "rows": [sweep_row(row) for row in rows.itertuples()],
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


def make(template: str, scaling: pd.DataFrame) -> str:
    """The page from its template and the table of scaling."""
    return render(template, values(scaling, scaling.attrs["sharing"]))
