"""A scene of the open benchmark as JSON: parameters, initial state, reference states with error bars, and events."""

import json

import numpy as np

from conveyor import DESCRIPTIONS, PARAMETERS, UNITS, Run, parameter_table, simulate
from conveyor.methods import modes
from pipeline import grid

STATE = {"x": "m", "vx": "m/s", "z": "m", "vz": "m/s"}
SAMPLES = 100  # reference states of a scene, evenly spaced in time
REFERENCE = 1e-14  # tolerance of the reference solution
COMPARED = (1e-13, 1e-12)  # tolerances of two more solutions, whose difference from the reference is the error bar
ROUNDING = 4.0 * np.finfo(np.float64).eps  # smallest error bar, over the largest value


def error_bars(reference: np.ndarray, others: list[np.ndarray]) -> np.ndarray:
    """The largest difference of `others` from the reference up to each time; all of shape (n,)."""
    differences = np.max([np.abs(other - reference) for other in others], axis=0)
    return np.maximum.accumulate(np.maximum(differences, ROUNDING * np.abs(reference).max()))


def event_rows(run: Run, others: list[Run]) -> list[dict]:
    """Time (s), error bar (s) and kind of each event; no error bars if the kinds differ between solutions."""
    events = run.events
    same = all(np.array_equal(other.events["kind"], events["kind"]) for other in others)
    bars = error_bars(events["time"], [other.events["time"] for other in others]) if same and len(events) else None
    return [
        {"time": float(event["time"]), "error": None if bars is None else float(bars[k]), "kind": str(event["kind"])}
        for k, event in enumerate(events)
    ]


def describe_scene(settings: dict) -> dict:
    """The content of the file, from the settings of the scene in the config."""
    conveyor, start = grid.conveyor_and_start(settings["model"])
    options = {"duration": settings["duration"], "reuse": False}
    run, *others = (simulate(conveyor, start, tolerance=tolerance, **options) for tolerance in (REFERENCE, *COMPARED))
    times = np.linspace(0.0, settings["duration"], SAMPLES + 1)[1:]
    initial = run.sample(np.zeros(1))
    reference, *compared = (one.sample(times) for one in (run, *others))
    scales = dict(zip(STATE, modes.scales(parameter_table(conveyor, start)).tolist(), strict=True))
    parameters = {name: getattr(conveyor, name) for name in PARAMETERS if name not in ("z0", "vz0")}
    return {
        "scene": settings["scene"],
        "parameters": {
            name: {"value": value, "unit": UNITS[name], "description": DESCRIPTIONS[name]}
            for name, value in parameters.items()
        },
        "units": {"times": "s", "events": "s", **STATE},
        "initial": {name: float(initial[name][0]) for name in STATE},
        "duration": settings["duration"],
        "scales": scales,
        "times": times.tolist(),
        "reference": {name: reference[name].tolist() for name in STATE},
        "error": {name: error_bars(reference[name], [one[name] for one in compared]).tolist() for name in STATE},
        "events": event_rows(run, others),
    }


def make(settings: dict) -> str:
    """The file of a scene, with one key per line."""
    scene = describe_scene(settings)
    lines = (f"{json.dumps(key)}: {json.dumps(value, ensure_ascii=False)}" for key, value in scene.items())
    return "{\n" + ",\n".join(lines) + "\n}\n"
