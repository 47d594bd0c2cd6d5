"""Rule figure_costs: what each figure took, from the benchmark files of the jobs that it needs."""

from pathlib import Path

import pandas as pd

from rule_log import logged

HEAD = "| Command | Wall time, s | Largest memory, MiB | Tables |\n|---|---|---|---|\n"


def cost(files: list[str]) -> tuple[float, float]:
    """Sum of the wall times (s) and largest resident memory (MiB) of the jobs with these benchmark files."""
    rows = pd.concat([pd.read_csv(file, sep="\t", na_values="-") for file in files])
    return float(rows["s"].sum()), float(rows["max_rss"].max())


def report(figures: dict[str, dict]) -> str:
    """The table in Markdown, for figures with their benchmark `files` and `tables`."""
    lines = []
    for name, entry in figures.items():
        seconds, memory = cost(entry["files"])
        tables = ", ".join(f"`{table}`" for table in entry["tables"]) or "none"
        lines.append(f"| `snakemake figures/{name}.pdf` | {seconds:.0f} | {memory:.0f} | {tables} |\n")
    everything = sorted({file for entry in figures.values() for file in entry["files"]})
    seconds, memory = cost(everything)
    lines.append(f"| all of them | {seconds:.0f} | {memory:.0f} | |\n")
    return (
        "# What each figure costs\n\n"
        "Sum of the wall times of all jobs that a figure needs, one by one, on the machine where this was made "
        "(`snakemake docs/figures.md`); jobs that several figures share count in each. On several cores jobs run "
        "side by side.\n\n" + HEAD + "".join(lines)
    )


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        Path(snakemake.output[0]).write_text(report(snakemake.params.figures), encoding="utf-8")
