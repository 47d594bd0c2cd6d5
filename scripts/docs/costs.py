"""What each figure and claim took, from the benchmark files of the jobs that the workflow says it needs."""

import io
import json
import subprocess
import sys

import pandas as pd


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


def cost(files: set[str]) -> dict[str, float | int]:
    """Sum of the wall times (s) and largest resident memory (MiB) of the jobs with these benchmark files."""
    if not files:
        return {"seconds": 0.0, "memory": 0.0, "jobs": 0}
    rows = pd.concat([pd.read_csv(file, sep="\t", na_values="-") for file in sorted(files)])
    return {"seconds": float(rows["s"].sum()), "memory": float(rows["max_rss"].max()), "jobs": len(files)}


def make(figures: dict[str, list[str]], claims: dict[str, list[str]], snakefile: str, configfiles: list[str]) -> str:
    """Seconds, MiB and number of jobs of each figure, of each claim, and of everything, as JSON.

    Parameters
    ----------
    figures, claims : the files that each is made from
    snakefile, configfiles : the workflow that says which jobs a file needs
    """
    table = summary(
        sorted({file for files in [*figures.values(), *claims.values()] for file in files}), snakefile, configfiles
    )

    def jobs(files: list[str]) -> set[str]:
        return set().union(*(jobs_of(file, table) for file in files))

    of_figures, of_claims = ({name: jobs(files) for name, files in group.items()} for group in (figures, claims))
    everything = set().union(*of_figures.values(), *of_claims.values())
    found = {
        "figures": {name: cost(files) for name, files in of_figures.items()},
        "claims": {name: cost(files) for name, files in of_claims.items()},
        "everything": cost(everything),
    }
    return json.dumps(found, indent=1)
