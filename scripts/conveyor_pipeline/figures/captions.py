"""The caption of a figure: numbers from the tables that the figures draw, filled into their templates.

The text is in plots/NAME.rst, behind the title. A second paragraph is a remark on the paper's conveyor, which other
conveyors do not get. Fields are the tables and settings of the figure, and the numbers that caption_numbers/NAME.py
computes, if there is such a module.
"""

import importlib
import inspect

import pandas as pd

from conveyor_pipeline.common.steepness import is_steep
from conveyor_pipeline.common.templates import name_harmonics, render
from conveyor_pipeline.figures.titles import caption_file, package_of, split_title


def caption(template: str, name: str, tables: dict[str, pd.DataFrame], settings: dict, paper: bool = True) -> str:
    """The caption of a figure from its template, tables and settings, and its numbers in caption_numbers/.

    `paper` says whether the figure shows the paper's conveyor. Harmonics of the plate are named at the end.

    Raises
    ------
    jinja2.UndefinedError
        if the template uses a value that is in none of them
    """
    values = {**tables, **settings}
    numbers = {}
    if package := package_of(name, "caption_numbers"):
        function = importlib.import_module(f"{package}.{name}").numbers
        parameters = inspect.signature(function).parameters
        numbers = function(**{name: values[name] for name in parameters if name in values})
    template, _, remark = template.partition("\n\n")
    if paper and remark:
        template = f"{template.rstrip()} {remark}"
    conveyor = "the paper's conveyor" if paper else "this conveyor"
    models = [table.attrs["model"] for table in tables.values() if "friction" in table.attrs.get("model", {})]
    about = {"conveyor": conveyor, "slides": any(map(is_steep, models))}
    try:
        text = render(template, values | numbers | about)
    except Exception as error:
        error.add_note(f"in {caption_file(name)}")
        raise
    # Tables of the motion normal to the track have models without friction.
    for harmonics in sorted({name_harmonics(table.attrs.get("model", {})) for table in tables.values()} - {""}):
        text = f"{text.rstrip()} The plate's motion has {harmonics}.\n"
    return text


def make(figure: str, settings: dict, paper: bool, template: str, **tables: pd.DataFrame) -> str:
    """The caption of a figure.

    Parameters
    ----------
    settings : of the figure
    paper : whether the figure shows the paper's conveyor
    template : with the title
    tables : by their roles
    """
    return caption(split_title(template)[1], figure, tables, settings, paper)
