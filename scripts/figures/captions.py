"""Captions of all figures: numbers from the tables that the figures draw, filled into their templates.

The text is in plots/NAME.rst, behind the title. Its fields are the tables and settings of the figure, and the numbers
that caption_numbers/NAME.py computes, if there is such a module.
"""

import importlib.util
import inspect

import pandas as pd

from figures.titles import split_title
from operating.regimes import is_steep
from pipeline.templates import name_harmonics, render


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
    if importlib.util.find_spec(module := f"figures.caption_numbers.{name}"):
        function = importlib.import_module(module).numbers
        parameters = inspect.signature(function).parameters
        numbers = function(**{name: values[name] for name in parameters if name in values})
    conveyor = "the paper's conveyor" if paper else "this conveyor"
    models = [table.attrs["model"] for table in tables.values() if "friction" in table.attrs.get("model", {})]
    about = {"paper": paper, "conveyor": conveyor, "slides": any(map(is_steep, models))}
    try:
        text = render(template, values | numbers | about)
    except Exception as error:
        error.add_note(f"in scripts/figures/plots/{name}.rst")
        raise
    # Tables of the motion normal to the track have models without friction.
    for harmonics in sorted({name_harmonics(table.attrs.get("model", {})) for table in tables.values()} - {""}):
        text = f"{text.rstrip()} The plate's motion has {harmonics}.\n"
    return text


def make(
    figures: dict[str, dict], paper: bool, references: list[str], read: list[pd.DataFrame], templates: list[str]
) -> list[str]:
    """The captions of all figures, in order.

    Parameters
    ----------
    figures : entries of the config
    paper : whether the figures show the paper's conveyor
    references, read : names of the tables, SECTION/NAME, and the tables
    templates : one per figure, each with its title
    """
    tables_by_name = dict(zip(references, read, strict=True))
    captions = []
    for (name, entry), template in zip(figures.items(), templates, strict=True):
        roles = {**entry["tables"], **entry.get("caption_tables", {})}
        tables = {role: tables_by_name[reference] for role, reference in roles.items()}
        captions.append(caption(split_title(template)[1], name, tables, entry.get("settings", {}), paper))
    return captions
