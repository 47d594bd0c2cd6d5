"""The arguments that the config gives to plots and captions are the arguments in their signatures."""

import importlib
import inspect

import pytest
from jinja2.meta import find_undeclared_variables
from project import read_config

from conveyor.methods import fixed_step, scheme
from conveyor_pipeline.common.templates import ENVIRONMENT
from conveyor_pipeline.figures import style
from conveyor_pipeline.figures.titles import caption_file, package_of

CONFIG = read_config()
FIGURES = CONFIG["figures"] | CONFIG["figures_on_request"]


def names(entry, keys=("tables", "settings")):
    return [name for key in keys for name in entry.get(key, {})]


@pytest.mark.parametrize("figure", FIGURES)
def test_a_plot_takes_the_tables_and_settings_of_its_figure(figure):
    entry = FIGURES[figure]
    plot = importlib.import_module(f"{package_of(figure)}.{figure}").plot
    given = names(entry, ("tables", "settings", "marks"))
    assert len(given) == len(set(given)), "a table and a setting share a name"
    inspect.signature(plot).bind(**dict.fromkeys(given))
    # Figures of other conveyors have no marks of the paper.
    inspect.signature(plot).bind(**dict.fromkeys(names(entry)))


@pytest.mark.parametrize("figure", FIGURES)
def test_the_values_of_a_caption_exist(figure):
    wanted = find_undeclared_variables(ENVIRONMENT.parse(caption_file(figure).read_text(encoding="utf-8")))
    given = names(FIGURES[figure], ("tables", "caption_tables", "settings"))
    package = package_of(figure, "caption_numbers")
    if not package:
        assert wanted <= {"conveyor", "slides", "outcomes", *given}, "the caption needs a module in caption_numbers"
        return
    parameters = inspect.signature(importlib.import_module(f"{package}.{figure}").numbers).parameters
    assert {name for name, one in parameters.items() if one.default is one.empty} <= set(given)
    # A table that only the caption has is used by its function or its text.
    assert set(FIGURES[figure].get("caption_tables", {})) <= {*parameters, *wanted}


@pytest.mark.parametrize("method", fixed_step.METHODS)
def test_a_method_with_a_fixed_step_is_complete(method):
    assert method in style.METHODS
    assert method in fixed_step.GROWTH
    assert len(scheme.EVALUATIONS) == len(fixed_step.METHODS)
