"""The page of what each figure costs."""

import json

HEAD = (
    "# What each figure costs\n\n"
    "Sum of the wall times of all jobs that a figure needs, one by one, on the machine where this was made "
    "(`snakemake docs/figures.md`); jobs that several figures share count in each. Other jobs ran "
    "beside them, on the same cores: a figure that is made alone takes less.\n\n"
    "| Command | Wall time, s | Largest memory, MiB | Jobs |\n|---|---|---|---|\n"
)


def make(costs: str, figures: list[str]) -> str:
    """The page, from the costs of figures and claims as JSON."""
    found = json.loads(costs)
    rows = {f"`snakemake figures/{name}.pdf`": found[name] for name in figures}
    rows["all of them, and the claims"] = found["everything"]
    lines = [f"| {name} | {one['seconds']:.0f} | {one['memory']:.0f} | {one['jobs']} |\n" for name, one in rows.items()]
    return HEAD + "".join(lines)
