"""Settings of the stage accuracy: comparisons of methods, with units and ranges."""

from operator import itemgetter

from typing_extensions import TypedDict

from conveyor_pipeline.common.settings import (
    MOST_POINTS,
    Duration,
    Effort,
    Line,
    Name,
    Reference,
    described,
    list_of,
    mapping,
    whole,
)
from conveyor_pipeline.common.table_settings import model_of
from conveyor_pipeline.study.accuracy.scenes import LONGEST, SCENES

Repeats = whole("repetitions", 1, 10**9)


class Precision(TypedDict):
    duration: Duration
    repeats: Repeats


class SceneBudget(TypedDict):
    effort: Effort
    reasons: described(dict[Reference, Line], "why a table is more accurate than its figure needs")


class MapCheck(TypedDict):
    maps: list_of(Name, "sweeps over two parameters")
    points: whole("points of each map", 1, MOST_POINTS)


SECTIONS = {
    "precision": described(Precision, "error against cost of all methods"),
    "stability": mapping("limits of stability of the methods", {"effort": Effort}),
    "scene_budget": described(SceneBudget, "accuracy that each figure needs"),
    "map_check": described(MapCheck, "check of state maps by brute force"),
    "settling_times": mapping("time until a motion settles", {"effort": Effort}),
}
# Points of a table of each section that are compared with a more accurate solution, by an effort of 1.
BUDGETED = {
    "sweeps": 400,
    "signals": 10,
    "spectra": 10,
    "estimates": 60,
    "critical": 10,
    "impacts": 400,
    "dimensions": 8,
    "attractors": 60,
    "lyapunov": 20,
}


def precision_settings(config: dict, scene: str) -> dict:
    """The settings of a scene; `default` is the tolerance at which the solver is compared with the paper's method."""
    duration = config["precision"]["duration"]
    return {
        "duration": min(duration, LONGEST.get(scene, duration)),
        "default": config["solver"]["tolerance"],
        "model": {**config["model"], **SCENES[scene]},
    }


def scene_budget_settings(config: dict) -> dict:
    budget = config["scene_budget"]
    points = {section: max(1, round(budget["effort"] * count)) for section, count in BUDGETED.items()}
    return {"points": points, "reasons": budget["reasons"]}


def settling_settings(config: dict) -> dict:
    solver = {key: config["solver"][key] for key in ("tolerance", "settling")}
    return {**solver, **config["settling_times"], "model": model_of(config, normal=True)}


TABLE_SETTINGS = {
    "results/stability": itemgetter("stability"),
    "results/theory": lambda config: {"model": model_of(config)},
    **dict.fromkeys(("results/scene_budget", "results/budget_times"), scene_budget_settings),
    "results/map_check": itemgetter("map_check"),
    "results/settling_times": settling_settings,
}
# Kinds of tables with one table for each scene.
TABLE_FAMILIES = dict.fromkeys(("precision", "precision_times"), (tuple(SCENES), precision_settings))
