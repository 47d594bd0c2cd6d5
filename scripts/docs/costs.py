"""What each figure and claim took, from the benchmark files of the jobs that the workflow says it needs."""

import io
import json
import subprocess
import sys

import pandas as pd

EVERYTHING = "everything"


def summary(targets: list[str], snakefile: str, configfiles: list[str]) -> pd.DataFrame:
    """Snakemake's own account of all files behind some targets: output_file, rule, log-file(s), input-file(s), …"""
    options = ["--configfile", *configfiles] if configfiles else []
    run = subprocess.run(
        [
            sys.executable,
            "-m",
            "snakemake",
            "--snakefile",
            snakefile,
            "--nolock",
            "--detailed-summary",
            *targets,
            *options,
        ],
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    return pd.read_csv(io.StringIO(run.stdout), sep="\t", dtype=str, keep_default_na=False)


def jobs_of(target: str, table: pd.DataFrame) -> set[str]:
    """The benchmark files of all jobs that a target needs, its own included."""
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


def cost(files: set[str]) -> tuple[float, float]:
    """Sum of the wall times (s) and largest resident memory (MiB) of the jobs with these benchmark files."""
    rows = pd.concat([pd.read_csv(file, sep="\t", na_values="-") for file in sorted(files)])
    return float(rows["s"].sum()), float(rows["max_rss"].max())


def make(files: dict[str, list[str]], snakefile: str, configfiles: list[str]) -> str:
    """What some things cost, by the files that each is made from: seconds, MiB and the number of jobs, as JSON."""
    table = summary(sorted({file for of_one in files.values() for file in of_one}), snakefile, configfiles)
    jobs = {name: set().union(*(jobs_of(file, table) for file in of_one)) for name, of_one in files.items()}
    found = {}
    for name, benchmarks in (jobs | {EVERYTHING: set().union(*jobs.values())}).items():
        seconds, memory = cost(benchmarks) if benchmarks else (0.0, 0.0)
        found[name] = {"seconds": seconds, "memory": memory, "jobs": len(benchmarks)}
    return json.dumps(found, indent=1)
