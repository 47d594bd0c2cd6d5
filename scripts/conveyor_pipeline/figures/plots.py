"""A figure: drawn from its tables by the function `plot` of its module, as PDF and as PNG."""

import importlib

import pandas as pd

from conveyor_pipeline.figures import style
from conveyor_pipeline.figures.titles import package_of


def draw(figure: str, settings: dict, **tables: pd.DataFrame) -> style.Figure:
    """The figure with a name, from its tables by their roles in the plot function."""
    plot = importlib.import_module(f"{package_of(figure)}.{figure}").plot
    with style.applied():
        return plot(**tables, **settings)


def make(figure: str, settings: dict, **tables: pd.DataFrame) -> dict[str, bytes]:
    """The content of the files of a figure."""
    return style.encode(draw(figure, settings, **tables))
