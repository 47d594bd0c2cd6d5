"""Scores of a solver on the open benchmark: errors of trajectory and events, and processor time."""

import json
import runpy
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pandas as pd

from conveyor import Conveyor, Start, parameter_table
from conveyor.methods import event_driven, fixed_step

Solver = Callable[[dict, float], dict]

COMPARED = ("x", "z")
TOLERANCES = (1e-4, 1e-6, 1e-8)  # for solvers whose file has no TOLERANCES
OWN_TOLERANCES = (1e-3, 1e-5, 1e-7, 1e-9, 1e-11)  # of this project's solver
EULER_STEPS = (1e-5, 2e-6, 5e-7)  # s; the last one is the published step
REPEATS, SECONDS = 21, 0.5  # most timed runs, and processor time after which a run is not repeated
COLUMNS = ("scene", "run", "seconds", "time", *COMPARED)  # of a CSV file with results


def read_scenes(folder: Path) -> dict[str, dict]:
    """The scenes of the benchmark by name; ValueError if the folder has none."""
    scenes = {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in sorted(folder.glob("*.json"))}
    if not scenes:
        raise ValueError(f"{folder} has no scenes; make them: snakemake docs/add_your_solver.md")
    return scenes


def root_mean_square(scene: dict, errors: dict[str, np.ndarray]) -> float:
    """Root mean square of the errors of x and z (m) at all times, in units of the plate's motion."""
    scaled = [np.asarray(errors[name]) / scene["scales"][name] for name in COMPARED]
    return float(np.sqrt(np.mean(np.square(scaled))))


def error_bar(scene: dict) -> float:
    """Error of the reference solution, in units of the plate's motion."""
    return root_mean_square(scene, scene["error"])


def trajectory_error(scene: dict, solution: dict) -> float:
    """Root mean square error of x and z at the times of a scene, in units of the plate's motion.

    Raises
    ------
    ValueError
        names a missing quantity, or one of a wrong shape
    """
    errors = {}
    for name in COMPARED:
        reference = np.array(scene["reference"][name])
        values = np.asarray(solution.get(name, ()), dtype=float)
        if values.shape != reference.shape:
            expected = f"one number for each of the {len(reference)} times of the scene {scene['scene']}"
            raise ValueError(f"{name} must have {expected}, got the shape {values.shape}")
        errors[name] = values - reference
    return root_mean_square(scene, errors)


def event_error(scene: dict, solution: dict) -> float:
    """Largest error of the impact times (s); NaN without events, infinity for a wrong number of impacts."""
    if "events" not in solution:
        return np.nan
    times = [event["time"] for event in scene["events"] if event["kind"] == "impact"]
    own = [float(moment) for moment, kind in solution["events"] if kind == "impact"]
    if len(own) != len(times):
        return np.inf
    return float(np.abs(np.subtract(own, times)).max(initial=0.0))


def time_solver(solve: Solver, scene: dict, tolerance: float) -> tuple[dict, float]:
    """A solution, and its median processor time (s). The first run, which may compile code, is not timed."""
    solution = solve(scene, tolerance)
    spent: list[float] = []
    while len(spent) < REPEATS and sum(spent) < SECONDS:
        begin = time.process_time()
        solution = solve(scene, tolerance)
        spent.append(time.process_time() - begin)
    return solution, float(np.median(spent))


def score(scene: dict, name: str, run: str, solution: dict, seconds: float) -> dict:
    """One row of the table of scores."""
    errors = {"error": trajectory_error(scene, solution), "impact_error": event_error(scene, solution)}
    return {"scene": scene["scene"], "solver": name, "run": run, **errors, "seconds": seconds}


def score_function(
    scenes: dict[str, dict], name: str, solve: Solver, tolerances=TOLERANCES, key: str = "tolerance"
) -> Iterator[dict]:
    """Scores of a Python function at some tolerances."""
    for scene in scenes.values():
        for tolerance in tolerances:
            yield score(scene, name, f"{key} {tolerance:g}", *time_solver(solve, scene, tolerance))


def score_numbers(scenes: dict[str, dict], name: str, table: pd.DataFrame) -> Iterator[dict]:
    """Scores of a table of results with COLUMNS and one row per scene, run and time."""
    if missing := [column for column in COLUMNS if column not in table]:
        raise ValueError(f"{name} lacks the columns {', '.join(missing)}")
    for (scene, run), rows in table.groupby(["scene", "run"], sort=False):
        if scene not in scenes:
            raise ValueError(f"{name}: the benchmark has no scene {scene!r}; there are {', '.join(scenes)}")
        rows = rows.sort_values("time", kind="stable")
        times = scenes[scene]["times"]
        if len(rows) != len(times) or not np.allclose(rows.time, times, rtol=0.0, atol=1e-9):
            raise ValueError(f"{name}: scene {scene}, run {run}: the times differ from the times of the scene")
        yield score(scenes[scene], name, str(run), rows[list(COMPARED)].to_dict("list"), float(rows.seconds.iloc[0]))


def score_file(scenes: dict[str, dict], file: Path) -> list[dict]:
    """Scores of a Python file with the function `solve`, or of a CSV file with results."""
    if file.suffix == ".csv":
        return list(score_numbers(scenes, file.stem, pd.read_csv(file)))
    module = runpy.run_path(str(file))
    if "solve" not in module:
        raise ValueError(f"{file} has no function solve(scene, tolerance)")
    return list(score_function(scenes, file.stem, module["solve"], module.get("TOLERANCES", TOLERANCES)))


def pack_scene(scene: dict) -> np.ndarray:
    """The parameters of a scene."""
    parameters = {name: entry["value"] for name, entry in scene["parameters"].items()}
    return parameter_table(Conveyor(**parameters), Start(z=scene["initial"]["z"], vz=scene["initial"]["vz"]))


def solve_by_events(scene: dict, tolerance: float) -> dict:
    """Solve a scene with this project's solver, without reuse of steps."""
    room = 2 * len(scene["events"])  # a loose tolerance may find more events than the reference has
    samples, events = event_driven.follow(pack_scene(scene), np.array(scene["times"]), tolerance, room)
    return {name: samples[name] for name in COMPARED} | {"events": events}


def solve_by_euler(scene: dict, step: float) -> dict:
    """Solve a scene with the paper's method, explicit Euler, and a time step (s)."""
    return fixed_step.sample(pack_scene(scene), np.array(scene["times"]), step, "euler")


def compared_scores(scenes: dict[str, dict]) -> list[dict]:
    """Scores of this project's solver and of the paper's method on this machine."""
    return [
        *score_function(scenes, "this solver", solve_by_events, OWN_TOLERANCES),
        *score_function(scenes, "explicit Euler", solve_by_euler, EULER_STEPS, "step"),
    ]
