"""The page on the cost of large sweeps on a cluster, from measured jobs."""

import math

import numpy as np
import pandas as pd

from pipeline.templates import render

NODES = 50  # at a time, in the example of the page


def total_costs(table: pd.DataFrame) -> pd.DataFrame:
    """The costs of each whole sweep and of a full shard, in proportion to the points of the computed shards."""
    rows = table[table.varied == "points"].sort_values("points")
    seconds_of_row = (rows.gathering_seconds / rows.gathered).iloc[-1]
    return rows.assign(
        microseconds=1e6 * rows.computing_seconds / rows.computed,
        core_hours=rows.points / rows.computed * rows.shard_seconds * rows.threads / 3600.0,
        job_seconds=rows.shard_seconds / rows.computed * rows.rows,
        minutes=np.where(rows.gathered == rows.points, rows.gathering_seconds, rows.points * seconds_of_row) / 60.0,
        gigabytes=rows.points * rows.bytes / 1e9,
    )


def make(template: str, scaling: pd.DataFrame) -> str:
    """The page from its template and the table of scaling."""
    sharing, rows = scaling.attrs["sharing"], total_costs(scaling)
    largest = rows.iloc[-1]
    long = scaling[scaling.computing_seconds > 1.0]
    one = scaling[(scaling.varied == "threads") & (scaling.threads == scaling.threads.min())].iloc[0]
    loading = scaling.loading_seconds.div(scaling.measured).median()
    values = {
        "sharing": sharing,
        "rows": rows,
        "largest": largest,
        "conveyors": scaling[scaling.varied == "conveyors"].sort_values("points").iloc[-1],
        "estimated_hours": largest.shards * largest.estimated_seconds * largest.threads / 3600.0,
        "nodes": NODES,
        "wall_minutes": math.ceil(largest.shards / NODES) * largest.job_seconds / 60.0,
        "most_memory": max(scaling.shard_memory.max(), scaling.gathering_memory.max()),
        "ratio": long.estimated_seconds * long.computed / long.rows / long.computing_seconds,
        "microseconds": 1e6 * one.computing_seconds / one.computed,
        "start": scaling.shard_seconds.sub(scaling.computing_seconds).div(scaling.measured).median() - loading,
        "loading": loading,
    }
    return render(template, values)
