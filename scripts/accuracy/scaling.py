"""What the jobs of sweeps take over points, threads, shards and conveyors: wall times, and the most memory they have.

Every job is measured in a process of its own, from its start on, as a cluster starts it. A shard's first points are
computed twice: the first time loads the compiled code, which can so be told from computing. What a few seconds take
depends on what else the machine does: such shards are made several times, in turns with those of other sweeps, and
medians count. Of the largest sweeps one shard is made; what puts the shards together is measured on copies of it, of
which more change nothing but the time.
"""

import json
import math
import os
import re
import subprocess
import sys
import tempfile
from itertools import product
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np
import pandas as pd
import pyarrow.parquet as pq

from conveyor.analysis.attractors import convergence_lanes
from conveyor.solver.progress import bar
from pipeline import fields, tables
from sweeps import shards

SCRIPTS = Path(__file__).resolve().parents[1]
# Rounds in which the shards of each sweep are made again, until those of it have taken so many seconds.
ROUNDS, ENOUGH = 5, 30.0
MOST_GATHERED = 3  # copies of a shard of which a measured table is put together

TABLES = {
    "scaling": (
        fields.text("varied", "what the rows of this kind differ in: points, conveyors, threads, shards"),
        fields.count("points", "of the sweep"),
        fields.count("conveyors", "of the sweep"),
        fields.count("shards", "of the sweep"),
        fields.count("rows", "of a shard"),
        fields.count("threads", "of a shard"),
        fields.count(
            "measured", "shards that were made; of their memory the most counts below, of short times the median"
        ),
        fields.count("computed", "points of these shards"),
        fields.number("shard_seconds", "s", "wall time of a shard, from the start of Python; of several the sum"),
        fields.number(
            "loading_seconds", "s", "of it the first points alone, which load the compiled code; of several the sum"
        ),
        fields.number(
            "computing_seconds", "s", "of it all points after that, with the writing of them; of several the sum"
        ),
        fields.number("shard_memory", "MB", "most resident memory of a shard"),
        fields.number(
            "estimated_seconds", "s", "of a shard on its threads, as the config estimates it to cut the sweep"
        ),
        fields.number("estimated_memory", "MB", "of a shard, as it asks a cluster for it"),
        fields.count("gathered", "rows that were put together"),
        fields.number("gathering_seconds", "s", "wall time of that, from the start of Python"),
        fields.number("gathering_memory", "MB", "most resident memory of that"),
        fields.number("bytes", "B", "size of the file, for each row"),
    ),
}


def peak_memory() -> float:
    """MB, the most resident memory that this process has had; not what it inherited from the one that started it."""
    return int(re.search(r"VmHWM:\s+(\d+) kB", Path("/proc/self/status").read_text())[1]) * 1024 / 1e6


def make_shard(path: str, settings: dict, rows: tuple[int, int], threads: int) -> float:
    """Write some rows of a sweep to `path`; the wall time (s) of that."""
    begin = perf_counter()
    schema = [*(fields.AXES[axis] for axis in settings["axes"]), *shards.TABLES["sweeps"]]
    blocks = shards.make(settings, rows, threads=threads)
    tables.write_blocks(path, (tables.make("sweeps", schema, block, settings) for block in blocks))
    return perf_counter() - begin


def job() -> None:
    """What a measured process does: as the task on stdin says; it answers on stdout."""
    task = json.load(sys.stdin)
    times = {}
    if "shards" in task:
        # Copies of shards do not hold the rows that their places ask for.
        tables.gather(task["path"], task["shards"], "sweeps", task["settings"], task["rows"], lambda rows: {})
    else:
        begin, end = task["rows"]
        # Fewer would not load the code of starts that are followed side by side.
        first_points = task | {"rows": (begin, min(begin + convergence_lanes.SIDE_BY_SIDE, end))}
        times = {"loading": make_shard(**first_points)}
        os.unlink(task["path"])  # no job writes over a file
        times["computing"] = make_shard(**task)
    json.dump(times | {"memory": peak_memory()}, sys.stdout)


def run(**task: Any) -> dict[str, float]:
    """Most memory (MB) and wall times (s) of one job: the whole from the start of Python, and what a shard's is of."""
    begin = perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", "from accuracy import scaling; scaling.job()"],
        input=json.dumps(task),
        stdout=subprocess.PIPE,
        text=True,
        check=True,
        env=os.environ | {"PYTHONPATH": str(SCRIPTS)},
    )
    return json.loads(done.stdout) | {"whole": perf_counter() - begin}


def shards_of(case: dict, folder: Path) -> list[dict[str, float]]:
    """`run` for each shard of a case that is to be made."""
    rows, points = case["plan"]["rows"], case["plan"]["points"]
    return [
        run(
            settings=case["settings"],
            threads=case["threads"],
            path=str(folder / f"{k}.parquet"),
            rows=[k * rows, min((k + 1) * rows, points)],
        )
        for k in range(case["measured"])
    ]


def gather_shards(case: dict, folder: Path) -> dict[str, float]:
    """`run` for what puts the shards of a case together, how many rows it has, and the size (B) of the file."""
    paths, shards_of_all = [str(folder / f"{k}.parquet") for k in range(case["measured"])], case["plan"]["shards"]
    copies = paths if len(paths) == shards_of_all else paths * min(shards_of_all, MOST_GATHERED)
    rows = sum(pq.read_metadata(path).num_rows for path in copies)
    whole = folder / "all.parquet"
    found = run(settings=case["settings"], shards=copies, rows=rows, path=str(whole))
    return found | {"rows": rows, "bytes": whole.stat().st_size}


def medians(rounds: list[list[dict[str, float]]]) -> list[dict[str, float]]:
    """Of each shard over rounds the medians of its times, and its most memory."""
    return [
        {name: (max if name == "memory" else median)(one[name] for one in of_one) for name in of_one[0]}
        for of_one in zip(*rounds, strict=True)
    ]


def row(case: dict, made: list[dict[str, float]], together: dict[str, float]) -> dict[str, Any]:
    """A row of the table for one `case`, from `medians` of its shards and what `gather_shards` says.

    A case says what is varied, the settings of its sweep, its plan, its threads, and how many shards are to be made.
    """
    plan = case["plan"]
    return {
        "varied": case["varied"],
        "points": plan["points"],
        "conveyors": case["conveyors"],
        "shards": plan["shards"],
        "rows": plan["rows"],
        "threads": case["threads"],
        "measured": len(made),
        "computed": min(len(made) * plan["rows"], plan["points"]),
        "shard_seconds": math.fsum(one["whole"] for one in made),
        "loading_seconds": math.fsum(one["loading"] for one in made),
        "computing_seconds": math.fsum(one["computing"] for one in made),
        "shard_memory": max(one["memory"] for one in made),
        "estimated_seconds": plan["seconds"] / case["threads"],
        "estimated_memory": plan["memory"],
        "gathered": together["rows"],
        "gathering_seconds": together["whole"],
        "gathering_memory": together["memory"],
        "bytes": together["bytes"] / together["rows"],
    }


def make(settings: dict, cases: list[dict], *, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table for `cases`, one row each; what has to be compiled is compiled before."""

    with tempfile.TemporaryDirectory() as folder:
        for one in cases:
            rows = [0, min(convergence_lanes.SIDE_BY_SIDE, one["plan"]["points"])]
            run(settings=one["settings"], threads=1, rows=rows, path=f"{folder}/one.parquet")
    times, together = [[] for _ in cases], {}
    for number, k in bar(list(product(range(ROUNDS), range(len(cases)))), label=progress, unit="sweeps"):
        if math.fsum(one["whole"] for shards in times[k] for one in shards) >= ENOUGH:
            continue
        with tempfile.TemporaryDirectory() as folder:
            times[k].append(shards_of(cases[k], Path(folder)))
            if number == 0:
                together[k] = gather_shards(cases[k], Path(folder))
    rows = (row(case, medians(times[k]), together[k]) for k, case in enumerate(cases))
    return {name: column.to_numpy() for name, column in pd.DataFrame(rows).items()}
