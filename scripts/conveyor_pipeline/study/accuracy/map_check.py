"""State maps by brute force: random points of maps, simulated with a tight tolerance until their attractor is certain.

The labels of a map come from a fast search: with a loose tolerance, with many parts at a time, and only until a part
cannot leave a known attractor. Here, every part is simulated alone by the event-driven solver, without reuse of steps,
orbits or chaotic sets. An attractor is certain in two cases:

- The part repeats its height and velocity at the end of a cycle with one period for many cycles in a row.
- It does not do so within the largest number of cycles, and its largest Lyapunov exponent is positive by several
  standard errors, which means chaos.

All other points are `undecided` and count as different labels.
"""

from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.ndimage import generate_binary_structure, maximum_filter, minimum_filter

from conveyor import conveyor_and_start, lyapunov_spectrum, sample_runs, simulate
from conveyor.analysis.attractors.labels import LONG_FLIGHT
from conveyor.analysis.stroboscopic_map import repeated_period
from conveyor.methods import modes
from conveyor.parallel import for_each_chunk
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.common.axes import count_values

TABLES = {
    "map_check": (
        fields.text("map", "name of the sweep"),
        fields.count("row", "row of the sweep"),
        fields.flag("near_boundary", "whether a neighbour in the map has another label"),
        fields.text("label", "state of motion in the map"),
        fields.text("state", "state of motion by brute force"),
        fields.count("period", "excitation cycles; 0 for none"),
        fields.count("cycles", "simulated excitation cycles"),
        fields.number("exponent", "1/s", "largest Lyapunov exponent; null for periodic motions"),
        fields.number("exponent_error", "1/s", "standard error of the exponent; null for periodic motions"),
    ),
}

BOUNDARY = 0.5  # share of the points that lie next to a point with another label
SEED = 1
# Excitation cycles without a period, after which a motion is chaos if its exponent is positive: as many as the default
# of solver.settling.
CYCLES = 20_000
TOLERANCE = 1e-13
CLOSE = 1e-9  # largest difference of a repeated state, in units of the plate's motion
REPEATS = 64  # excitation cycles in a row that must repeat in a periodic motion
SIGNIFICANT = 3.0  # standard errors by which a positive exponent must exceed zero
# Largest accepted share of different labels, which a reader of a map does not see (PIXELS in scene_budget.py). It was
# set before the number was known.
ACCEPTED = 0.01
BLOCK = 256  # cycles per call of the solver
EXPONENT = {"transient": 0, "cycles": 100, "blocks": 20}  # cycles in each block, and blocks, for the exponent


class Settled(NamedTuple):
    """The end of a simulation until the motion repeats itself, or until the limit."""

    period: int  # cycles; 0 for none
    cycles: int  # simulated cycles
    end: np.ndarray  # the parameters that continue the motion


def is_near_boundary(labels: np.ndarray) -> np.ndarray:
    """Whether one of the four neighbours in a map of labels, shape (n, m), has another label."""
    states = np.unique(labels, return_inverse=True)[1].reshape(labels.shape)
    cross = generate_binary_structure(2, 1)
    # The filters continue the map with the labels of its edge, so that no boundary appears there.
    return maximum_filter(states, footprint=cross) != minimum_filter(states, footprint=cross)


def draw_rows(near: np.ndarray, points: int, random: np.random.Generator) -> np.ndarray:
    """As many random rows of a map as `points`, a share BOUNDARY of them near a boundary; fewer if it has not enough.

    near : whether each row is near a boundary, bool, shape (n,)
    """
    close, far = np.flatnonzero(near), np.flatnonzero(~near)
    close_count = min(round(BOUNDARY * points), len(close))
    far_count = min(points - close_count, len(far))
    return np.sort(
        np.concatenate([random.choice(close, close_count, replace=False), random.choice(far, far_count, replace=False)])
    )


def simulate_until_settled(row: np.ndarray) -> Settled:
    """Simulate the motion of a row of a table until it repeats itself."""
    row = np.array(row)
    scale = modes.scales(row)[2:]
    times = np.arange(1, BLOCK + 1)[None] / row["frequency"]
    options = {"columns": ["z", "vz"], "tolerance": TOLERANCE, "reuse": False}
    period = cycles = 0
    while not period and cycles < CYCLES:
        run = sample_runs(row[None], times, **options)
        if run.status[0] != "ok":
            break
        strobes = np.column_stack([run.z[0], run.vz[0]])
        row["z0"], row["vz0"] = strobes[-1]
        cycles += BLOCK
        period = repeated_period(strobes / scale, REPEATS, CLOSE)
    return Settled(period, cycles, row)


def longest_flight(row: np.ndarray, period: int) -> float:
    """The longest flight (excitation cycles) of the periodic motion from parameters on its orbit."""
    cycles = 2 * period + 1  # a flight may begin before the initial time and be longer than a cycle
    run = simulate(*conveyor_and_start(row), duration=cycles / row["frequency"], tolerance=TOLERANCE, reuse=False)
    changes = run.events[np.isin(run.events["kind"], ["impact", "separation"])]
    flights = np.diff(changes["time"])[changes["kind"][1:] == "impact"]
    return flights.max(initial=0.0) * row["frequency"]


def brute_force(rows: np.ndarray, *, threads: int = 1, progress: str | None = None) -> dict:
    """State, period, simulated cycles and exponent of each row of a table of parameters."""
    settled: list[Settled] = [None] * len(rows)
    flights = np.zeros(len(rows))
    ends = rows.copy()

    def work(begin, end):
        for k in range(begin, end):
            settled[k] = simulate_until_settled(rows[k])
            ends[k] = settled[k].end
            if settled[k].period:
                flights[k] = longest_flight(ends[k], settled[k].period)

    for_each_chunk(work, len(rows), threads=threads, chunk=1, progress=progress)
    period = np.array([motion.period for motion in settled])
    states = np.where(flights >= LONG_FLIGHT, "second", "first").astype(object)
    exponent, error = np.full((2, len(rows)), np.nan)
    open_rows = np.flatnonzero(period == 0)
    if len(open_rows):
        spectrum = lyapunov_spectrum(ends[open_rows], **EXPONENT, tolerance=TOLERANCE, threads=threads)
        exponent[open_rows], error[open_rows] = spectrum.lambda_1, spectrum.stderr
        is_chaos = spectrum.lambda_1 > SIGNIFICANT * spectrum.stderr
        states[open_rows] = np.where(is_chaos, "chaos", "undecided")
    return {
        "state": states,
        "period": period,
        "cycles": np.array([motion.cycles for motion in settled]),
        "exponent": exponent,
        "exponent_error": error,
    }


def make(
    settings: dict, maps: list[pd.DataFrame], *, threads: int = 1, progress: str | None = None
) -> dict[str, np.ndarray]:
    """The columns of the table of checked points; `maps` are the tables of the sweeps of the config, in order."""
    random = np.random.default_rng(SEED)
    chosen, parameters = [], []
    for name, table in zip(settings["maps"], maps, strict=True):
        axes = table.attrs["axes"]
        near = is_near_boundary(table.state.to_numpy().reshape([count_values(axis) for axis in axes.values()]))
        rows = draw_rows(near.ravel(), settings["points"], random)
        label = table.state.to_numpy()[rows]
        near_boundary = near.ravel()[rows]
        chosen.append(pd.DataFrame({"map": name, "row": rows, "near_boundary": near_boundary, "label": label}))
        parameters += [grid.product(axes, table.attrs["model"], (row, row + 1))[1] for row in rows.tolist()]
    simulated = brute_force(np.concatenate(parameters), threads=threads, progress=progress)
    return pd.concat(chosen, ignore_index=True).to_dict("list") | simulated
