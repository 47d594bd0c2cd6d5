"""Distribution of the figures over the pages of the report; imported by the Snakefile, so without slow imports."""

import re

BEYOND = "beyond the paper"
# Figures per page beyond the paper: browsers do not show pages of more than two megabytes.
FIGURES_ON_PAGE = 5


def figure_pages(figures: dict[str, dict], folder: str) -> list[dict]:
    """File, heading, section, label and figures of each page in a folder.

    Each section of the paper has a page, in the order of the paper. The figures beyond the paper come last, on several
    pages.
    """
    sections = {}
    for name, figure in sorted(figures.items(), key=lambda item: item[1]["section"]):
        number = re.fullmatch(r"fig(\d+)", name)
        numbered = {**figure, "number": f"Fig. {int(number[1])}" if number else name}
        sections.setdefault(figure["section"] if number else BEYOND, []).append(numbered)
    beyond = sections.pop(BEYOND, [])
    parts = [beyond[first : first + FIGURES_ON_PAGE] for first in range(0, len(beyond), FIGURES_ON_PAGE)]
    sections |= {f"{BEYOND}, {place} of {len(parts)}": part for place, part in enumerate(parts, start=1)}
    pages = enumerate(sections.items(), start=1)
    return [{"file": f"{folder}/figures_{place}.html"} | describe_page(*part) for place, part in pages]


def describe_page(section: str, figures: list[dict]) -> dict:
    """Heading, section, label and figures of a page."""
    first, last = figures[0]["number"], figures[-1]["number"]
    if section.startswith(BEYOND):
        heading, label = section.capitalize(), f"{len(figures)} figures"
    else:
        heading = f"Section {section}"
        label = first if first == last else f"{first} to {last.removeprefix('Fig. ')}"
    return {"heading": heading, "section": section, "label": label, "figures": figures}


def escape_label(text: str) -> str:
    """A label in which an invisible character keeps Snakemake from taking {name} for a wildcard."""
    return text.replace("{", "{\u2060")
