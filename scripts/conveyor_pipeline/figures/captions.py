"""The caption of a figure: numbers from the tables that the figures draw, filled into their templates.

The text is in figures/NAME.rst, behind the title. A second paragraph is a remark on the paper's conveyor, which other
conveyors do not get. Fields are the tables and settings of the figure, and the numbers that caption_numbers/NAME.py
computes, if there is such a module.
"""

import importlib
import inspect

import pandas as pd

from conveyor_pipeline.common.steepness import is_steep
from conveyor_pipeline.common.templates import name_harmonics, render
from conveyor_pipeline.figures.titles import caption_file, package_of, split_title


def name_state(state: str) -> str:
    """A state of motion in a sentence: "the first state", "chaos"."""
    return f"the {state} state" if state in ("first", "second") else state


def describe_outcomes(states: pd.Series) -> str:
    """Sentences about the states of a map: the only one, and the share of undecided initial conditions."""
    only, undecided = states.unique(), (states == "undecided").mean()
    texts = [f" All initial conditions lead to {name_state(only[0])}."] if len(only) == 1 and undecided < 1.0 else []
    if undecided:
        texts.append(
            f" The search ended before {100 * undecided:.3g} % of the initial conditions had settled (undecided). "
            "A larger value of ``solver.settling`` in the config follows them further."
        )
    return "".join(texts)


def make(figure: str, settings: dict, paper: bool, template: str, **tables: pd.DataFrame) -> str:
    """The caption of a figure. Harmonics of the plate are named at the end.

    Parameters
    ----------
    settings : of the figure
    paper : whether the text may speak of the paper, as it does in results without a prefix
    template : with the title
    tables : by their roles

    Raises
    ------
    jinja2.UndefinedError
        if the template uses a value that is in no table, setting or number
    """
    values = {**tables, **settings}
    numbers = {}
    if package := package_of(figure, "caption_numbers"):
        function = importlib.import_module(f"{package}.{figure}").numbers
        parameters = inspect.signature(function).parameters
        numbers = function(**{name: values[name] for name in parameters if name in values})
    text, _, remark = split_title(template)[1].partition("\n\n")
    if paper and remark:
        text = f"{text.rstrip()} {remark}"
    conveyor = "the paper's conveyor" if paper else "this conveyor"
    models = [table.attrs["model"] for table in tables.values() if "friction" in table.attrs.get("model", {})]
    about = {"conveyor": conveyor, "slides": any(map(is_steep, models)), "outcomes": describe_outcomes}
    try:
        text = render(text, values | numbers | about)
    except Exception as error:
        error.add_note(f"in {caption_file(figure)}")
        raise
    # Tables of the motion normal to the track have models without friction.
    for harmonics in sorted({name_harmonics(table.attrs.get("model", {})) for table in tables.values()} - {""}):
        text = f"{text.rstrip()} The plate's motion has {harmonics}.\n"
    return text
