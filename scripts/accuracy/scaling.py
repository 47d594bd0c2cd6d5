"""Wall times and peak memory of the jobs of sweeps, over points, threads, shards and conveyors.

Every job runs in a process of its own, as on a cluster, and is measured from the start of Python. The first points of a
shard are computed twice: the first time loads the compiled code, which separates loading from computing. Short times
depend on the load of the machine. Short shards are therefore computed several times, in turns with other sweeps, and
medians are taken. Of the largest sweeps, only one shard is computed, and the job that joins the shards is measured on
copies of it.
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

import pyarrow.parquet as pq

from conveyor import LANES, progress_bar
from pipeline import fields, tables
from sweeps import shards

SCRIPTS = Path(__file__).resolve().parents[1]
# Most rounds of computing the shards of a sweep, and seconds after which they are not computed again.
ROUNDS, ENOUGH = 5, 30.0
MOST_GATHERED = 3  # most copies of a shard that are joined
# With fewer first points, the code for several initial conditions side by side would not be loaded.
FIRST_POINTS = int(LANES)

TABLES = {
    "scaling": (
        fields.text("varied", "varied quantity: points, conveyors, threads or shards"),
        fields.count("points", "points of the sweep"),
        fields.count("conveyors", "conveyors of the sweep"),
        fields.count("shards", "shards of the sweep"),
        fields.count("rows", "rows of a shard"),
        fields.count("threads", "threads of a shard"),
        fields.count("measured", "number of computed shards"),
        fields.count("computed", "points of the computed shards"),
        fields.number("shard_seconds", "s", "sum of the wall times of the shards, from the start of Python"),
        fields.number("loading_seconds", "s", "wall time of the first points, which load the compiled code"),
        fields.number("computing_seconds", "s", "wall time of computing and writing all later points"),
        fields.number("shard_memory", "MB", "peak resident memory of a shard, the largest of all"),
        fields.number("estimated_seconds", "s", "wall time of a shard by the estimate that determines its size"),
        fields.number("estimated_memory", "MB", "memory of a shard that a cluster is asked for"),
        fields.count("gathered", "rows of the joined shards"),
        fields.number("gathering_seconds", "s", "wall time of joining the shards, from the start of Python"),
        fields.number("gathering_memory", "MB", "peak resident memory of joining the shards"),
        fields.number("bytes", "B", "size of the file per row"),
    ),
}


def peak_memory() -> float:
    """Peak resident memory (MB) of this process, without the memory of its parent, unlike getrusage."""
    return int(re.search(r"VmHWM:\s+(\d+) kB", Path("/proc/self/status").read_text())[1]) * 1024 / 1e6


def make_shard(path: str, settings: dict, rows: tuple[int, int], threads: int) -> float:
    """Write some rows of a sweep to `path`, and return the wall time (s)."""
    begin = perf_counter()
    schema = [*(fields.AXES[axis] for axis in settings["axes"]), *shards.TABLES["sweeps"]]
    blocks = shards.make(settings, rows, threads=threads)
    tables.write_blocks(path, (tables.make("sweeps", schema, block, settings) for block in blocks))
    return perf_counter() - begin


def run_job() -> None:
    """The main function of a measured process: reads its task from stdin and writes times and memory to stdout."""
    task = json.load(sys.stdin)
    times = {}
    if "shards" in task:
        # No expected values, because copies of a shard have equal rows.
        tables.gather(task["path"], task["shards"], "sweeps", task["settings"], task["rows"], lambda rows: {})
    else:
        begin, end = task["rows"]
        first_points = task | {"rows": (begin, min(begin + FIRST_POINTS, end))}
        times = {"loading": make_shard(**first_points)}
        os.unlink(task["path"])  # as in a real job, the file must not exist
        times["computing"] = make_shard(**task)
    json.dump(times | {"memory": peak_memory()}, sys.stdout)


def measure_job(**task: Any) -> dict[str, float]:
    """Peak memory (MB) and wall times (s) of one job: `whole` from the start of Python, and the parts of a shard."""
    begin = perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", "from accuracy import scaling; scaling.run_job()"],
        input=json.dumps(task),
        stdout=subprocess.PIPE,
        text=True,
        check=True,
        env=os.environ | {"PYTHONPATH": str(SCRIPTS)},
    )
    return json.loads(done.stdout) | {"whole": perf_counter() - begin}


def measure_shards(case: dict, folder: Path) -> list[dict[str, float]]:
    """The results of `measure_job` for each computed shard of a case."""
    rows, points = case["plan"]["rows"], case["plan"]["points"]
    return [
        measure_job(
            settings=case["settings"],
            threads=case["threads"],
            path=str(folder / f"{k}.parquet"),
            rows=[k * rows, min((k + 1) * rows, points)],
        )
        for k in range(case["measured"])
    ]


def measure_gathering(case: dict, folder: Path) -> dict[str, float]:
    """The results of `measure_job` for joining the shards of a case, with the rows and the size (B) of the file."""
    paths, count = [str(folder / f"{k}.parquet") for k in range(case["measured"])], case["plan"]["shards"]
    copies = paths if len(paths) == count else paths * min(count, MOST_GATHERED)
    rows = sum(pq.read_metadata(path).num_rows for path in copies)
    joined = folder / "all.parquet"
    measured = measure_job(settings=case["settings"], shards=copies, rows=rows, path=str(joined))
    return measured | {"rows": rows, "bytes": joined.stat().st_size}


def summarise(rounds: list[list[dict[str, float]]]) -> list[dict[str, float]]:
    """The median times and the largest memory of each shard over all rounds."""
    return [
        {name: (max if name == "memory" else median)(one[name] for one in shard) for name in shard[0]}
        for shard in zip(*rounds, strict=True)
    ]


def make_row(case: dict, shard_results: list[dict[str, float]], gathering: dict[str, float]) -> dict[str, Any]:
    """The row of a case, from `summarise` of its shards and from `measure_gathering`.

    A case has the varied quantity, settings, plan and threads of its sweep, and the number of shards to compute.
    """
    plan = case["plan"]
    return {
        "varied": case["varied"],
        "points": plan["points"],
        "conveyors": case["conveyors"],
        "shards": plan["shards"],
        "rows": plan["rows"],
        "threads": case["threads"],
        "measured": len(shard_results),
        "computed": min(len(shard_results) * plan["rows"], plan["points"]),
        "shard_seconds": math.fsum(shard["whole"] for shard in shard_results),
        "loading_seconds": math.fsum(shard["loading"] for shard in shard_results),
        "computing_seconds": math.fsum(shard["computing"] for shard in shard_results),
        "shard_memory": max(shard["memory"] for shard in shard_results),
        "estimated_seconds": plan["seconds"] / case["threads"],
        "estimated_memory": plan["memory"],
        "gathered": gathering["rows"],
        "gathering_seconds": gathering["whole"],
        "gathering_memory": gathering["memory"],
        "bytes": gathering["bytes"] / gathering["rows"],
    }


def make(settings: dict, cases: list[dict], *, progress: str | None = None) -> dict[str, list]:
    """The columns of the table, with one row per case. Code is compiled before the first measurement."""
    with tempfile.TemporaryDirectory() as folder:
        for one in cases:
            rows = [0, min(FIRST_POINTS, one["plan"]["points"])]
            measure_job(settings=one["settings"], threads=1, rows=rows, path=f"{folder}/one.parquet")
    times, gathering = [[] for _ in cases], {}
    for number, k in progress_bar(list(product(range(ROUNDS), range(len(cases)))), label=progress, unit="sweeps"):
        if math.fsum(one["whole"] for shards in times[k] for one in shards) >= ENOUGH:
            continue
        with tempfile.TemporaryDirectory() as folder:
            times[k].append(measure_shards(cases[k], Path(folder)))
            if number == 0:
                gathering[k] = measure_gathering(cases[k], Path(folder))
    rows = [make_row(case, summarise(times[k]), gathering[k]) for k, case in enumerate(cases)]
    return fields.columns(rows, TABLES["scaling"])
