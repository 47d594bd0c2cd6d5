"""Rule scene_budget: what the data of each figure need, what that costs, and what a reader would see of less.

A sample of the points of each sweep that a figure shows is followed with the settings of the config and with every
variant: other tolerances, with and without the horizontal motion, the rigid bouncing part in place of the contact. A
point where a shift of the initial height that nobody can set (config: `shift`) changes what a reader sees, as in long
transients, does not count, nor does a velocity in chaos: there the model itself makes no statement.
"""

from collections.abc import Callable
from time import perf_counter
from typing import Any

import numpy as np

from conveyor import grid, rigid_ball, states, sweep, tables
from conveyor.model import Z0, unpack
from rule_log import logged

FULL = {"needs": "feeding", "tolerance": 1e-13}
RIGID = "rigid part"
ROUNDS, ENOUGH = 3, 0.05  # of a timed run: at least that many, and that many seconds altogether


def least_time(work: Callable[[], Any]) -> tuple[float, Any]:
    """Least wall time (s) of repeated rounds, and what `work` returns: other load on the machine only adds to a time.

    The first round, which may have to load compiled code, is not timed.
    """
    result = work()
    times = []
    while len(times) < ROUNDS or sum(times) < ENOUGH:
        begin = perf_counter()
        work()
        times.append(perf_counter() - begin)
    return min(times), result


def sample_of(settings: dict, count: int, seed: int) -> np.ndarray:
    """Parameter vectors of some points of a sweep, drawn without repetition, shape (count, 13)."""
    _, parameters = grid.product(settings["axes"], settings["model"])
    rows = np.random.default_rng(seed).choice(len(parameters), min(count, len(parameters)), replace=False)
    return parameters[np.sort(rows)]


def follow(
    parameters: np.ndarray, duration: float, needs: str, tolerance: float
) -> tuple[float, np.ndarray, np.ndarray]:
    """Wall time (s), mean velocities (m/s; NaN for vertical needs) and states that the runs lead to."""
    options = {"duration": duration, "needs": needs, "tolerance": tolerance}
    seconds, runs = least_time(lambda: sweep.run(parameters, **options))
    later = states.continued(parameters, runs["z_end"], runs["vz_end"], duration)
    return seconds, runs["mean_velocity"], states.classify(later)[0]


def follow_rigid(parameters: np.ndarray, duration: float, speeds: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """The same for rigid parts whose restitution is that of the contact; second if the longest flights are long."""
    restitution = speeds, rigid_ball.restitution_coefficients(parameters[0], speeds)
    seconds, runs = least_time(lambda: [rigid_ball.run(row, duration, restitution) for row in parameters])
    found = [rigid_state(row, duration, restitution) for row in parameters]
    return seconds, np.array([run.mean_velocity for run in runs]), np.array(found)


def rigid_state(row: np.ndarray, duration: float, restitution: tuple[np.ndarray, np.ndarray]) -> str:
    """State of a rigid part at the end of a run: by its flights, and by whether it repeats itself."""
    conveyor, _ = unpack(row)
    cycle = 1.0 / conveyor.frequency
    hits = rigid_ball.impacts(row, duration, restitution)
    late = hits[hits["time"] > 0.75 * duration]
    flights = np.diff(late["time"])
    if len(flights) == 0 or flights.max() < states.LONG_FLIGHT * cycle:
        return "first"
    strobes = duration - cycle * np.arange(8)
    height = rigid_ball.sample(row, strobes, restitution)["z"]
    closest = min(np.abs(height[period:] - height[:-period]).max() for period in (1, 2, 4))
    last_cycle = rigid_ball.sample(row, duration - cycle * np.linspace(0.0, 1.0, 50), restitution)["z"]
    return "second" if closest < 0.01 * np.ptp(last_cycle) else "chaos"


def changed(truth: tuple, found: tuple, line: float) -> tuple[np.ndarray, np.ndarray]:
    """Points with another state, and points whose velocity differs by more than a line is wide; both of shape (n,)."""
    _, velocity, state = truth
    _, other, other_state = found
    return other_state != state, np.abs(other - velocity) > line * np.ptp(velocity)


def rows_of_sweep(name: str, settings: dict, budget: dict) -> list[dict]:
    """One row for each variant of one sweep."""
    parameters = sample_of(settings, budget["points"], budget["seed"])
    duration, needs = settings["duration"], settings.get("needs", "feeding")
    truth = follow(parameters, duration, **FULL)
    shifted = parameters.copy()
    shifted[:, Z0] += budget["shift"]
    state, velocity = changed(truth, follow(shifted, duration, **FULL), budget["line"])
    known = ~state, ~(state | velocity | (truth[2] == "chaos"))
    variants = {(needs, tolerance) for tolerance in budget["tolerances"]}
    variants |= {(needs, settings["tolerance"]), ("feeding", settings["tolerance"])}
    rows = []
    for kind, tolerance in sorted(variants):
        found = follow(parameters, duration, kind, tolerance)
        rows.append(row(name, kind, tolerance, found, truth, known, budget))
        rows[-1]["chosen"] = kind == needs and tolerance == settings["tolerance"]
    if len(np.unique(parameters[:, 4:10], axis=0)) == 1:
        found = follow_rigid(parameters, duration, np.geomspace(1e-3, 1.0, 16))
        rows.append(row(name, RIGID, np.nan, found, truth, known, budget))
    return rows


def row(name: str, kind: str, tolerance: float, found: tuple, truth: tuple, known: tuple, budget: dict) -> dict:
    """One variant: its cost and what it changes among the points whose truth is known."""
    shares = [
        float(differs[counts].mean()) if counts.any() and kind_counts else 0.0
        for differs, counts, kind_counts in zip(
            changed(truth, found, budget["line"]), known, (True, kind != "vertical"), strict=True
        )
    ]
    return {
        "sweep": name,
        "variant": kind,
        "tolerance": tolerance,
        "seconds": found[0] / len(truth[1]),
        "full_seconds": truth[0] / len(truth[1]),
        "ratio": truth[0] / found[0],
        "states_known": float(known[0].mean()),
        "states_changed": shares[0],
        "velocities_known": float(known[1].mean()),
        "velocities_changed": shares[1],
        "visible": max(shares) > budget["pixels"],
        "chosen": False,
    }


def columns(sweeps: dict[str, dict], figures: dict[str, list[str]], budget: dict) -> dict[str, np.ndarray]:
    """The columns of the table of budgets for sweeps by name and the figures that show them."""
    rows = [one for name, settings in sweeps.items() for one in rows_of_sweep(name, settings, budget)]
    found = {name: np.array([one[name] for one in rows]) for name in rows[0]}
    return {**found, "figures": np.array([", ".join(figures[name]) for name in found["sweep"]])}


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        parameters = snakemake.params
        found = columns(parameters.sweeps, parameters.figures, parameters.budget)
        tables.write(snakemake.output[0], "scene_budget", found, settings=parameters.budget)
