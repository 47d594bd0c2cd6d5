"""Time and memory of each figure and claim, from the benchmark files of all jobs behind it."""

import io
import json
import re
import subprocess
import sys
from pathlib import Path

import pandas as pd

from pipeline.rule_log import COMPILED


def summary(targets: list[str], snakefile: str, options: list[str]) -> pd.DataFrame:
    """Snakemake's detailed summary of all files behind some targets: output_file, log-file(s), input-file(s), …"""
    command = [sys.executable, "-m", "snakemake", "--snakefile", snakefile, "--nolock", "--detailed-summary"]
    run = subprocess.run([*command, *targets, *options], stdout=subprocess.PIPE, text=True, check=True)
    return pd.read_csv(io.StringIO(run.stdout), sep="\t", dtype=str, keep_default_na=False)


def jobs_of(target: str, table: pd.DataFrame) -> set[str]:
    """The benchmark files of all jobs behind a target, including its own."""
    rows = table.set_index("output_file")
    waiting, seen, jobs = [target], set(), set()
    while waiting:
        file = waiting.pop()
        if file in seen or file not in rows.index:
            continue
        seen.add(file)
        row = rows.loc[file]
        jobs.add(row["log-file(s)"].replace("/logs/", "/benchmarks/").removesuffix(".log") + ".tsv")
        waiting += filter(None, row["input-file(s)"].split(","))
    return jobs


def compile_seconds(file: str) -> float:
    """The time that the job with a benchmark file has spent compiling, s, from its log; 0 if it compiled nothing."""
    log = Path(file.replace("/benchmarks/", "/logs/")).with_suffix(".log")
    match = re.search(rf"^{COMPILED}([\d.]+) s$", log.read_text(encoding="utf-8"), re.MULTILINE)
    return float(match[1]) if match else 0.0


def sum_costs(files: set[str]) -> dict[str, float | int]:
    """Sum of the wall times (s) and peak memory (MiB) of the jobs with these benchmark files.

    `compiling` is the part of the wall times that was spent compiling, s.
    """
    if not files:
        return {"seconds": 0.0, "compiling": 0.0, "memory": 0.0, "jobs": 0}
    rows = pd.concat([pd.read_csv(file, sep="\t", na_values="-") for file in sorted(files)])
    return {
        "seconds": float(rows["s"].sum()),
        "compiling": sum(map(compile_seconds, files)),
        "memory": float(rows["max_rss"].max()),
        "jobs": len(files),
    }


def make(figures: dict[str, list[str]], claims: dict[str, list[str]], snakefile: str, options: list[str]) -> str:
    """The costs of each figure, of each claim, and of everything, as JSON; see `sum_costs`.

    figures, claims : the files behind each figure and claim, by name
    options : of Snakemake, which give it the same config
    """
    everything = sorted({file for files in [*figures.values(), *claims.values()] for file in files})
    table = summary(everything, snakefile, options)

    def costs(files: list[str]) -> dict[str, float | int]:
        return sum_costs(set().union(*(jobs_of(file, table) for file in files)))

    found = {
        "figures": {name: costs(files) for name, files in figures.items()},
        "claims": {name: costs(files) for name, files in claims.items()},
        "everything": costs(everything),
    }
    return json.dumps(found, indent=1)
