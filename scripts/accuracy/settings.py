"""Settings of the stage accuracy: comparisons of methods, with units and ranges."""

from operator import itemgetter
from typing import Annotated

from pydantic import AfterValidator, Field
from typing_extensions import TypedDict

from ..pipeline.settings import (
    MODEL_TYPES,
    MOST_POINTS,
    Acceleration,
    Duration,
    Height,
    Line,
    Name,
    Reference,
    Seed,
    Step,
    Tolerance,
    check_span,
    many,
    mapping,
    number,
    span,
    whole,
)
from ..pipeline.table_settings import FOLLOWED, model_of, with_model
from .scenes import CHAOTIC, SCENES

Tolerances = many(Tolerance, "relative tolerances")
Steps = many(Step, "time steps of the fixed-step methods")
Cycles = whole("length of a run", 256, 10**9, "excitation cycles")
Repeats = whole("repetitions", 1, 10**9)
MaxEvaluations = whole("force evaluations after which a peer method is stopped", 1, 10**9)


class Precision(TypedDict):
    duration: Duration
    max_evaluations: MaxEvaluations
    repeats: Repeats


class Ride(TypedDict):
    start: Acceleration
    stop: Acceleration
    num: whole("number of amplitudes", 1, MOST_POINTS)
    z0: Height
    duration: Duration


class Stability(TypedDict):
    step: span(Step, "time steps")
    stiffness: span(MODEL_TYPES["stiffness"], "contact stiffnesses")
    damping: span(MODEL_TYPES["damping"], "contact damping coefficients")
    impact_velocity: span(number("impact velocity", "m/s", gt=0, le=100), "impact velocities")
    conveyor: Annotated[Ride, AfterValidator(check_span), Field(description="the paper's conveyor without chaos")]


BUDGETED = ("sweeps", "signals", "spectra", "estimates", "critical", "impacts", "dimensions", "attractors", "lyapunov")
Points = whole("number of points", 1, MOST_POINTS)


class SceneBudget(TypedDict):
    points: mapping("points of each table that are compared", dict.fromkeys(BUDGETED, Points))
    reasons: Annotated[dict[Reference, Line], Field(description="why a table is more accurate than its figure needs")]


class MapCheck(TypedDict):
    maps: many(Name, "sweeps over two parameters")
    points: whole("points of each map", 1, MOST_POINTS)
    cycles: Cycles


class SettlingTimes(TypedDict):
    acceleration: many(Acceleration, "amplitudes of the excitation")
    starts: whole("number of random initial conditions", 1, 10**6)
    cycles: Cycles
    seed: Seed


SECTIONS = {
    "benchmark": mapping("speed and error of the solver and of the paper's method", {"repeats": Repeats}),
    "precision": Annotated[Precision, Field(description="error against cost of all methods")],
    "stability": Annotated[Stability, Field(description="limits of stability of the methods")],
    "scene_budget": Annotated[SceneBudget, Field(description="accuracy that each figure needs")],
    "map_check": Annotated[MapCheck, Field(description="check of state maps by brute force")],
    "settling_times": Annotated[SettlingTimes, Field(description="time until a motion settles")],
}


def precision_settings(config: dict, scene: str) -> dict:
    shared = {name: config["precision"][name] for name in ("duration", "max_evaluations")}
    return {**shared, "model": {**config["model"], **SCENES[scene]}}


def published_scenes(config: dict) -> dict[str, dict]:
    """The settings of each scene that is published for other solvers."""
    duration = config["precision"]["duration"]
    scenes = [{"scene": name, "model": model, "duration": duration} for name, model in SCENES.items()]
    return {scene["scene"]: {**scene, "model": {**config["model"], **scene["model"]}} for scene in (*scenes, CHAOTIC)}


def reference_settings(config: dict) -> dict:
    """The scene whose reference is computed a second time: the jumping part."""
    return {"duration": config["precision"]["duration"], "model": {**config["model"], **SCENES["jumping"]}}


def benchmark_settings(config: dict) -> dict:
    return {**config["benchmark"], "tolerance": config["solver"]["tolerance"], "model": model_of(config)}


# The tables that are not entries, and the function that returns the settings of each.
TABLE_SETTINGS = {
    "results/benchmark": benchmark_settings,
    "results/reference_check": reference_settings,
    "results/stability": itemgetter("stability"),
    "results/stability_estimates": lambda config: {"model": model_of(config)},
    "results/scene_budget": itemgetter("scene_budget"),
    "results/budget_times": itemgetter("scene_budget"),
    "results/theory": lambda config: {"model": model_of(config)},
    "results/map_check": itemgetter("map_check"),
    "results/settling_times": lambda config: with_model(config, "settling_times", solver=FOLLOWED, normal=True),
}
