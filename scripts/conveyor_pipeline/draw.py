"""The script of every rule that draws a figure: read its tables, call its plot function, save the figure."""

import importlib
import sys
from collections.abc import Mapping
from pathlib import Path

# Snakemake puts the folder of all packages last on the path; an installed copy of the library would come first.
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from conveyor_pipeline.common import tables
from conveyor_pipeline.common.rule_log import check_code, logged
from conveyor_pipeline.figures import style
from conveyor_pipeline.figures.titles import package_of


def draw(name: str, paths: Mapping[str, str], expected: Mapping[str, list], settings: dict) -> style.Figure:
    """Draw the figure `name` from its tables.

    Parameters
    ----------
    paths : of the tables, by role in the plot function
    expected : kind and settings that each table must have, by path
    settings : of the figure

    Raises
    ------
    conveyor_pipeline.common.tables.TableError
        names a file that is not the expected table, and the remedy
    """
    plot = importlib.import_module(f"{package_of(name)}.{name}").plot
    with style.applied():
        return plot(**{role: tables.read(path, *expected[path]) for role, path in paths.items()}, **settings)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        check_code(snakemake.params.code)
        name, params = snakemake.wildcards.figure, snakemake.params
        figure = draw(name, dict(snakemake.input.items()), params.expected, params.settings)
        style.save(figure, snakemake.output)
