"""The script of every rule that draws a figure: read its tables, call its plot, save what it draws."""

import importlib
from collections.abc import Mapping

from matplotlib.figure import Figure

from figures import style
from pipeline import tables
from pipeline.rule_log import logged


def draw(name: str, paths: Mapping[str, str], kinds: Mapping[str, str], settings: dict) -> Figure:
    """Figure `name` from the tables at `paths`, by their names in the plot script; their settings are in `attrs`."""
    plot = importlib.import_module(f"figures.plots.{name}").plot
    with style.applied():
        return plot({role: tables.read(path, kinds[role]) for role, path in paths.items()}, settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        params = snakemake.params
        figure = draw(params.figure, dict(snakemake.input.items()), params.kinds, params.settings)
        style.save(figure, snakemake.output)
