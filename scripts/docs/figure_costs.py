"""What each figure took, from the benchmark files of the jobs that the workflow says it needs."""

import io
import subprocess
import sys

import pandas as pd

HEAD = "| Command | Wall time, s | Largest memory, MiB | Jobs |\n|---|---|---|---|\n"


def summary(targets: list[str], configfiles: list[str]) -> pd.DataFrame:
    """Snakemake's own account of all files behind some targets: output_file, rule, log-file(s), input-file(s), …"""
    options = ["--configfile", *configfiles] if configfiles else []
    run = subprocess.run(
        [sys.executable, "-m", "snakemake", "--nolock", "--detailed-summary", *targets, *options],
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


def report(jobs: dict[str, set[str]]) -> str:
    """The table in Markdown, for figures with the benchmark files of their jobs."""
    lines = []
    for name, files in jobs.items():
        seconds, memory = cost(files)
        lines.append(f"| `snakemake figures/{name}.pdf` | {seconds:.0f} | {memory:.0f} | {len(files)} |\n")
    everything = set().union(*jobs.values())
    seconds, memory = cost(everything)
    lines.append(f"| all of them | {seconds:.0f} | {memory:.0f} | {len(everything)} |\n")
    return (
        "# What each figure costs\n\n"
        "Sum of the wall times of all jobs that a figure needs, one by one, on the machine where this was made "
        "(`snakemake docs/figures.md`); jobs that several figures share count in each. On several cores jobs run "
        "side by side.\n\n" + HEAD + "".join(lines)
    )


def make(files: dict[str, str], configfiles: list[str]) -> str:
    """The page for the files of figures, by their names."""
    table = summary(list(files.values()), configfiles)
    return report({name: jobs_of(file, table) for name, file in files.items()})
