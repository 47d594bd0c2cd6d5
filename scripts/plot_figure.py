"""Rules plot_figNN: run the plot script of one figure on its tables and save what it draws."""

import importlib
from collections.abc import Mapping

import pandas as pd
from matplotlib.figure import Figure

from plots import style
from rule_log import logged


def draw(name: str, paths: Mapping[str, str], settings: dict) -> Figure:
    """Figure `name` from the tables at `paths`, by their names in the plot script; their settings are in `attrs`."""
    plot = importlib.import_module(f"plots.{name}").plot
    with style.applied():
        return plot({role: pd.read_parquet(path) for role, path in paths.items()}, settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        figure = draw(snakemake.params.figure, dict(snakemake.input.items()), snakemake.params.settings)
        style.save(figure, snakemake.output)
