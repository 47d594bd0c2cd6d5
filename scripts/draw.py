"""The script of every rule that draws a figure: read its tables, call its plot, save what it draws."""

import importlib
from collections.abc import Mapping

from matplotlib.figure import Figure

from figures import style
from pipeline import tables
from pipeline.rule_log import logged


def draw(
    name: str, paths: Mapping[str, str], kinds: Mapping[str, str], settings: dict, asked: Mapping[str, dict]
) -> Figure:
    """Figure `name` from tables; their settings are in `attrs`.

    Parameters
    ----------
    paths, kinds : of the tables, by their names in the plot script
    settings : of the figure
    asked : the settings that tables must have been made from, by their paths

    Raises
    ------
    pipeline.tables.TableError
        names a file that is not the table that is asked for, and the remedy
    """
    plot = importlib.import_module(f"figures.plots.{name}").plot
    with style.applied():
        return plot({role: tables.read(path, kinds[role], asked.get(path)) for role, path in paths.items()}, settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        params = snakemake.params
        figure = draw(params.figure, dict(snakemake.input.items()), params.kinds, params.settings, params.asked)
        style.save(figure, snakemake.output)
