"""Settings of the stage accuracy: comparisons of methods, with units and ranges."""

from operator import itemgetter
from typing import Annotated, NotRequired

from pydantic import AfterValidator, Field
from typing_extensions import TypedDict

from ..conveyor import FIXED_STEP_METHODS
from ..pipeline.settings import (
    MODEL_TYPES,
    MOST_POINTS,
    Acceleration,
    Duration,
    Height,
    HeightNumber,
    Line,
    Model,
    Name,
    Reference,
    Seed,
    Step,
    Tolerance,
    check_span,
    interval,
    many,
    mapping,
    number,
    span,
    whole,
    word,
)
from ..pipeline.table_settings import FOLLOWED, model_of, with_model

FixedStepMethod = word("method with a fixed step", *FIXED_STEP_METHODS)
Tolerances = many(Tolerance, "relative tolerances")
Steps = many(Step, "time steps of the fixed-step methods")
Cycles = whole("length of a run", 256, 10**9, "excitation cycles")
Repeats = whole("repetitions", 1, 10**9)
MaxEvaluations = whole("force evaluations after which a peer method is stopped", 1, 10**9)


class Goals(TypedDict):
    error: number("relative error of the mean velocity", gt=0, le=1e300)
    speed: number("goal of the speed, in units of explicit Euler's speed", gt=0, le=1e300)
    aim: number("ambition beyond this goal, in the same units", gt=0, le=1e300)


class Case(TypedDict):
    motion: Annotated[Line, Field(description="state of motion")]
    model: Model
    duration: NotRequired[Duration]
    loosest: NotRequired[Tolerance]
    step: NotRequired[Step]
    compared: number("time over which the error is measured", "s", gt=0, le=1e6)
    wanted: Annotated[Goals, Field(description="goals of the benchmark")]


class Benchmark(TypedDict):
    repeats: Repeats
    cases: Annotated[dict[Name, Case], Field(description="benchmark cases")]


class Precision(TypedDict):
    duration: Duration
    scenes: Annotated[dict[Name, Model], Field(description="conveyors by their names")]
    max_evaluations: MaxEvaluations
    repeats: Repeats


class PublishedScene(TypedDict):
    model: Model
    duration: Duration


class PublishedScenes(TypedDict):
    further: Annotated[dict[Name, PublishedScene], Field(description="scenes in addition to the scenes of `precision`")]


class Ride(TypedDict):
    start: Acceleration
    stop: Acceleration
    num: whole("number of amplitudes", 1, MOST_POINTS)
    z0: Height
    duration: Duration


class Stability(TypedDict):
    methods: many(FixedStepMethod, "methods with a fixed step")
    paper_step: Step
    step: span(Step, "time steps")
    contact: mapping("contact with p = 1", {name: MODEL_TYPES[name] for name in ("stiffness", "damping")})
    stiffness: span(MODEL_TYPES["stiffness"], "contact stiffnesses")
    damping: span(MODEL_TYPES["damping"], "contact damping coefficients")
    impact_velocity: span(number("impact velocity", "m/s", gt=0, le=100), "impact velocities")
    conveyor: Annotated[Ride, AfterValidator(check_span), Field(description="the paper's conveyor without chaos")]


BUDGETED = ("sweeps", "signals", "spectra", "estimates", "critical", "impacts", "dimensions", "attractors", "lyapunov")
Points = whole("number of points", 1, MOST_POINTS)


class SceneBudget(TypedDict):
    points: mapping("points of each table that are compared", dict.fromkeys(BUDGETED, Points))
    tolerances: Tolerances
    pixels: number("share of visibly changed values that is accepted", ge=0, le=1)
    line: number("visible change of a line, as a share of the axis", ge=0, le=1)
    reasons: Annotated[dict[Reference, Line], Field(description="why a table is more accurate than its figure needs")]


class MapCheck(TypedDict):
    maps: many(Name, "sweeps over two parameters")
    points: whole("points of each map", 1, MOST_POINTS)
    cycles: Cycles


class SettlingTimes(TypedDict):
    acceleration: many(Acceleration, "amplitudes of the excitation")
    starts: whole("number of random initial conditions", 1, 10**6)
    z0: interval(HeightNumber, "interval of the random initial heights")
    cycles: Cycles
    seed: Seed


SECTIONS = {
    "benchmark": Annotated[Benchmark, Field(description="speed and error of the solver and of the paper's method")],
    "precision": Annotated[Precision, Field(description="error against cost of all methods")],
    "published_scenes": Annotated[PublishedScenes, Field(description="benchmark for other solvers")],
    "stability": Annotated[Stability, Field(description="limits of stability of the methods")],
    "scene_budget": Annotated[SceneBudget, Field(description="accuracy that each figure needs")],
    "map_check": Annotated[MapCheck, Field(description="check of state maps by brute force")],
    "settling_times": Annotated[SettlingTimes, Field(description="time until a motion settles")],
}


def precision_settings(config: dict, scene: str) -> dict:
    """One scene of the section `precision`."""
    precision = config["precision"]
    shared = {name: precision[name] for name in ("duration", "max_evaluations")}
    return {**shared, "model": {**config["model"], **precision["scenes"][scene]}}


def published_scenes(config: dict) -> dict[str, dict]:
    """The settings of each scene that is published for other solvers."""
    precision = config["precision"]
    scenes = {name: {"model": model, "duration": precision["duration"]} for name, model in precision["scenes"].items()}
    return {
        name: {"scene": name, **scene, "model": {**config["model"], **scene["model"]}}
        for name, scene in {**scenes, **config["published_scenes"]["further"]}.items()
    }


def reference_settings(config: dict) -> dict:
    """The scene whose reference is computed a second time: the jumping part."""
    precision = config["precision"]
    return {"duration": precision["duration"], "model": {**config["model"], **precision["scenes"]["jumping"]}}


def benchmark_settings(config: dict) -> dict:
    """The cases of the benchmark with all defaults filled in."""
    solver = {key: config["solver"][key] for key in ("duration", "step")}
    cases = config["benchmark"]["cases"]
    return {
        "cases": {
            name: {**solver, **case, "model": {**config["model"], **case["model"]}} for name, case in cases.items()
        },
        "tolerance": config["solver"]["tolerance"],
        "repeats": config["benchmark"]["repeats"],
    }


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
