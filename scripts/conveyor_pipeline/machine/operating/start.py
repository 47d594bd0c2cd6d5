"""Switching on and off: how parts move while the amplitude rises, stays and falls.

The amplitude changes in small steps at the phases 0 and π, twice per excitation cycle. The plate goes on from its
position and with its velocity: gap, its rate, and slip are continuous, and only the acceleration changes, by the step.
Without harmonics and phase shift, these phases are the turning points of the plate, so that each stroke begins where
the last one ended. Otherwise the plate drifts over half a cycle by the change of its velocity, at most the step over ω,
and back over the next half. Because the equations of motion are the same in a frame that moves evenly, each half cycle
is a run with a constant amplitude, in the frame of its plate.

A part jumps if it had a flight of at least half a cycle, as in the labels of attractors; otherwise it rides.
"""

import math
from typing import NamedTuple

import numpy as np
import pandas as pd

from conveyor import RANGES, plate_motion, replace_parameters, sample_runs
from conveyor.analysis.attractors.labels import LONG_FLIGHT
from conveyor.elementary import cos, exp, log
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.machine.operating.parts import population, with_calibration
from conveyor_pipeline.machine.operating.populations import IDENTICAL, PROBABILITIES, VARIED
from conveyor_pipeline.machine.operating.ramps import (
    AT_REST,
    COUNTED,
    CYCLES,
    DOWN,
    FED,
    HOLD,
    JUMP_FIRST,
    KINDS,
    PUSHED,
    REPEATS,
    RIDE,
    SLOWLY,
    STAY,
    STEP,
    UP,
    WAYS,
    ramp_ends,
)
from conveyor_pipeline.machine.operating.transit import quantiles

SAMPLES = 16  # per half cycle, to find flights
ROWS = 25  # of a rise or a fall of the drive, at most
SAME = 1e-3  # of the plate's amplitude: largest difference of gaps that count as equal
LAST = (0.05, 0.5, 0.95)  # shares of the parts that have changed their motion
MEASURES = (
    fields.number("velocity_05", "m/s", "5 % quantile of the mean velocity of a part over the row"),
    fields.number("velocity_05_stderr", "m/s", "its standard error"),
    fields.number("velocity_50", "m/s", "median of the mean velocity"),
    fields.number("velocity_50_stderr", "m/s", "its standard error"),
    fields.number("jumping", "1", "share of the parts that jump; the others ride"),
    fields.count("failed", "parts whose run failed; the other columns do not contain them"),
)
AIM = fields.text("aim", f"fast or even, the amplitude of this advice; {SLOWLY} for slow ramps over all amplitudes")
PARTS = fields.text("parts", f"how they get onto the plate: {', '.join(KINDS)}")
TABLES = {
    "start": (
        AIM,
        PARTS,
        fields.text("way", f"of the amplitude: {', '.join(WAYS)}"),
        fields.number("time", "s", "middle of the row"),
        fields.number("acceleration", "m/s²", "mean amplitude of the row"),
        *MEASURES,
    ),
    "start_motions": (
        AIM,
        PARTS,
        fields.number("acceleration", "m/s²", "full amplitude"),
        *MEASURES,
        fields.number("repeating", "1", f"share of the parts that jump and repeat themselves within {REPEATS} cycles"),
    ),
    "start_limits": (
        fields.text("way", f"{UP}: a part begins to jump, {DOWN}: it jumps for the last time, in slow ramps"),
        fields.text("population", f"{IDENTICAL} (one part, with the parameters of the config) or {VARIED}"),
        fields.number("share", "1", "share of the parts that have done so; those that never jump have stopped"),
        fields.number("acceleration", "m/s²", "amplitude; null unless the status is ok"),
        fields.text("status", f"ok; {RIDE}: with this, fewer parts ever jump; or {JUMP_FIRST}"),
    ),
    "pushes": (
        AIM,
        fields.number("speed", "m/s", "of the push, away from the plate; 0 for no push"),
        fields.count("riding", "parts that ride before the push"),
        fields.number("made_jump", "1", "share of them that jump afterwards; null for none"),
        fields.count("jumping", "parts that jump before the push"),
        fields.number("made_ride", "1", "share of them that ride afterwards; null for none"),
    ),
}


class Motion(NamedTuple):
    """Parts at the beginning of a half cycle, relative to the plate. Each field has the shape (n,)."""

    gap: np.ndarray  # m
    rate: np.ndarray  # m/s
    slip: np.ndarray  # m/s, velocity of the part along the track minus that of the plate
    airborne: np.ndarray  # samples since the part left the plate, 0 in contact


class Path(NamedTuple):
    """What parts do in k half cycles."""

    travelled: np.ndarray  # m, shape (k, n); NaN from the half cycle on in which a run fails
    flight: np.ndarray  # longest flight until now of those that reach into the half cycle, in cycles, shape (k, n)
    gap: np.ndarray  # m, at the end of each half cycle, shape (k, n)


def plate_at_ends(model: dict) -> dict[str, np.ndarray]:
    """z (m), vz and vx (m/s) of a plate with the amplitude 1 m/s² at the phases 0 and π, each of the shape (2,)."""
    conveyor, _ = grid.conveyor_and_start({**model, "acceleration": 1.0, "psi0": 0.0})
    return plate_motion(conveyor, np.array([0.0, 0.5 / conveyor.frequency]))


def at_rest(rows: np.ndarray) -> Motion:
    """Parts that lie on the plate, pressed into it by their weight."""
    weight = rows["mass"] * rows["gravity"] * cos(rows["inclination"])
    gap = -exp(log(weight / rows["stiffness"]) / rows["exponent"])
    return Motion(gap, *np.zeros((2, len(rows))), np.zeros(len(rows), dtype=np.int64))


def dropped(amplitude: float, settings: dict, threads: int) -> Motion:
    """Parts from the box of initial conditions at the next phase 0 of a plate with a constant amplitude (m/s²)."""
    parts = population(np.array([amplitude]), settings)
    period = 1.0 / settings["model"]["frequency"]
    delay = (1.0 - parts["psi0"] / (2.0 * math.pi)) % 1.0 * period
    options = {"columns": ["z", "vz", "vx"], "tolerance": settings["tolerance"], "threads": threads}
    run = sample_runs(parts, delay[:, None], **options)
    scale = parts["acceleration"]
    plate = plate_at_ends(settings["model"])
    ends = [run[name][:, 0] - scale * plate[name][0] for name in ("z", "vz", "vx")]
    return Motion(*ends, np.zeros(len(parts), dtype=np.int64))


def follow(
    rows: np.ndarray, amplitudes: np.ndarray, motion: Motion, settings: dict, *, threads: int = 1
) -> tuple[Path, Motion]:
    """Follow parts while the amplitude takes a value in each half cycle, the first from phase 0 to π.

    Parameters
    ----------
    rows : parameters of the parts at an amplitude of 1 m/s², shape (n,)
    amplitudes : m/s², shape (k,)
    motion : at the beginning
    settings : `model` and `tolerance`
    """
    plate = plate_at_ends(settings["model"])
    half = 0.5 / settings["model"]["frequency"]
    times = np.tile(np.linspace(0.0, half, SAMPLES + 1), (len(rows), 1))
    options = {"columns": ["x", "vx", "z", "vz", "contact_force"], "tolerance": settings["tolerance"]}
    travelled, flights, gaps = np.empty((3, len(amplitudes), len(rows)))
    for k, amplitude in enumerate(amplitudes):
        begin, end = k % 2, (k + 1) % 2
        scale = rows["acceleration"] * amplitude
        start = replace_parameters(
            rows,
            acceleration=scale,
            psi0=math.pi * begin,
            z0=scale * plate["z"][begin] + motion.gap,
            vz0=scale * plate["vz"][begin] + motion.rate,
        )
        speed = scale * plate["vx"][begin] + motion.slip
        # A part that slides away is lost once it is faster than any run may begin.
        speed = np.where(np.abs(speed) <= RANGES["vz0"][1], speed, np.nan)
        run = sample_runs(start, times, vx0=speed, threads=threads, **options)
        airborne, longest = motion.airborne, motion.airborne
        for force in run.contact_force.T[1:]:
            airborne = np.where(force == 0.0, airborne + 1, 0)
            longest = np.maximum(longest, airborne)
        ends = {name: run[name][:, -1] - scale * plate[name][end] for name in ("z", "vz", "vx")}
        motion = Motion(ends["z"], ends["vz"], ends["vx"], airborne)
        travelled[k], flights[k], gaps[k] = run.x[:, -1], longest / (2.0 * SAMPLES), motion.gap
    return Path(travelled, flights, gaps), motion


def summarize(path: Path, places: slice, half: float) -> dict[str, float]:
    """The MEASURES over some half cycles, which take `half` (s) each."""
    velocity = path.travelled[places].mean(axis=0) / half
    jumps = path.flight[places].max(axis=0) >= LONG_FLIGHT
    right = np.isfinite(velocity)
    row = dict.fromkeys((column.name for column in MEASURES), math.nan) | {"failed": np.count_nonzero(~right)}
    if right.any():
        values, errors = quantiles(velocity[right])
        for place in (0, PROBABILITIES.index(0.5)):
            name = f"velocity_{round(100 * PROBABILITIES[place]):02d}"
            row |= {name: values[place], f"{name}_stderr": errors[place]}
        row["jumping"] = jumps[right].mean()
    return row


def table_of(path: Path, amplitudes: np.ndarray, ways: np.ndarray, per_row: dict[str, int], half: float) -> list[dict]:
    """Rows of the table start.

    amplitudes, ways : of the half cycles, shape (k,)
    per_row : half cycles per row, by the way
    """
    rows, begin = [], 0
    while begin < len(amplitudes):
        way = ways[begin]
        changes = np.flatnonzero(ways[begin:] != way)
        end = min(begin + per_row[way], begin + int(changes[0]) if len(changes) else len(ways))
        places = slice(begin, end)
        about = {"way": way, "time": 0.5 * (begin + end) * half, "acceleration": amplitudes[places].mean()}
        rows.append(about | summarize(path, places, half))
        begin = end
    return rows


def even_cycles(half_cycles: float) -> int:
    """The nearest number of half cycles that make whole cycles, at least one."""
    return 2 * max(1, round(half_cycles / 2.0))


def slow_amplitudes(low: float, high: float) -> np.ndarray:
    """Amplitudes (m/s²) of half cycles from low to high in steps of at most STEP."""
    return low * exp(np.linspace(0.0, math.log(high / low), even_cycles(math.log(high / low) / STEP) + 2))


def switching(amplitude: float, settings: dict) -> tuple[np.ndarray, np.ndarray]:
    """Amplitudes (m/s²) and ways of the half cycles of a rise, a stay and a fall."""
    count = even_cycles(2.0 * settings["rise"] * settings["model"]["frequency"])
    rise = amplitude * (np.arange(count) + 0.5) / count
    ways = np.repeat(WAYS, (count, 2 * HOLD, count))
    return np.concatenate([rise, np.full(2 * HOLD, amplitude), rise[::-1]]), ways


def repeats(gaps: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Whether motions repeat themselves after at most REPEATS cycles, shape (n,).

    gaps : m, at the end of each cycle, shape (k, n), k > 2 REPEATS
    scale : m, shape (n,), with which gaps are compared
    """
    last = gaps[-REPEATS:]
    periods = [np.abs(last - gaps[-REPEATS - p : -p]).max(axis=0) for p in range(1, REPEATS + 1)]
    return np.min(periods, axis=0) <= SAME * scale


def limits_of(up: np.ndarray, down: np.ndarray, paths: tuple[Path, Path]) -> list[dict]:
    """Rows of the table start_limits. The first part has the parameters of the config, the others differ.

    A part that jumps in the first cycles of the ramp up, or in the last ones of that down, changes its motion below the
    lowest amplitude.

    up, down : amplitudes (m/s²) of the half cycles of slow ramps
    """
    rows = []
    end = up[0] * (1.0 + 2 * CYCLES * STEP)
    for way, amplitudes, path in zip((UP, DOWN), (up, down), paths, strict=True):
        lowest = np.where(path.flight >= LONG_FLIGHT, amplitudes[:, None], math.inf).min(axis=0)
        lowest[lowest <= end] = -math.inf
        varied = np.sort(lowest[1:]) if way == UP else np.sort(lowest[1:])[::-1]
        places = [max(math.ceil(share * len(varied)) - 1, 0) for share in LAST]
        limits = [(IDENTICAL, 1.0, lowest[0]), *((VARIED, *pair) for pair in zip(LAST, varied[places], strict=True))]
        for kind, share, amplitude in limits:
            status = JUMP_FIRST if amplitude == -math.inf else RIDE if amplitude == math.inf else "ok"
            amplitude = amplitude if status == "ok" else None
            rows.append({"way": way, "population": kind, "share": share, "acceleration": amplitude, "status": status})
    return rows


def push(rows: np.ndarray, amplitude: float, before: tuple[Motion, np.ndarray], settings: dict, **options) -> list:
    """Rows of the table pushes at an amplitude (m/s²).

    before : the motion before the push, and whether each part jumps then
    """
    motion, jumped = before
    table = []
    for speed in (0.0, *settings["push"]):
        pushed = motion._replace(rate=motion.rate + speed)
        path, _ = follow(rows, np.full(2 * PUSHED, amplitude), pushed, settings, **options)
        jumps = path.flight[-2 * PUSHED // COUNTED :].max(axis=0) >= LONG_FLIGHT
        right = np.isfinite(path.travelled[-1])
        riding, jumping = (right & ~jumped, right & jumped)
        table.append(
            {
                "speed": speed,
                "riding": np.count_nonzero(riding),
                "made_jump": jumps[riding].mean() if riding.any() else math.nan,
                "jumping": np.count_nonzero(jumping),
                "made_ride": (~jumps[jumping]).mean() if jumping.any() else math.nan,
            }
        )
    return table


def slow_ramps(settings: dict, **options) -> tuple[list[dict], list[dict]]:
    """Rows of the tables start and start_limits for slow ramps over all amplitudes, of parts at rest."""
    half = 0.5 / settings["model"]["frequency"]
    axis = grid.axis_values("acceleration", settings["acceleration"])
    rows = np.concatenate([population(np.ones(1), settings, kind) for kind in (IDENTICAL, VARIED)])
    rows = rows[settings["starts"] - 1 :]  # one identical part, and the varied ones
    up = slow_amplitudes(*ramp_ends(axis))
    down = up[::-1]
    rising, motion = follow(rows, up, at_rest(rows), settings, **options)
    falling, _ = follow(rows, down, motion, settings, **options)
    path = Path(*(np.concatenate(pair)[:, 1:] for pair in zip(rising, falling, strict=True)))
    ways = np.repeat((UP, DOWN), len(up))
    table = table_of(path, np.concatenate([up, down]), ways, {UP: 2 * CYCLES, DOWN: 2 * CYCLES}, half)
    return [row | {"aim": SLOWLY, "parts": AT_REST} for row in table], limits_of(up, down, (rising, falling))


def make(
    advice: pd.DataFrame,
    settings: dict,
    samples: pd.DataFrame | None = None,
    parameters: pd.DataFrame | None = None,
    *,
    threads: int = 1,
) -> dict[str, dict]:
    """The columns of the tables.

    samples, parameters : as in transit.make
    """
    settings = with_calibration(settings, samples, parameters)
    options = {"threads": threads}
    half = 0.5 / settings["model"]["frequency"]
    start, limits = slow_ramps(settings, **options)
    motions, pushes = [], []
    rows = population(np.ones(1), settings)
    for aim, amplitude in zip(advice.aim, advice.acceleration, strict=True):
        amplitudes, ways = switching(amplitude, settings)
        per_row = {way: even_cycles(np.count_nonzero(ways == way) / ROWS) for way in WAYS}
        for kind in KINDS:
            begin = int(np.argmax(ways == STAY)) if kind == FED else 0
            first = amplitude if kind == FED else amplitudes[0]
            motion = at_rest(rows) if kind == AT_REST else dropped(first, settings, threads)
            fall = int(np.argmax(ways == DOWN))
            rising, motion = follow(rows, amplitudes[begin:fall], motion, settings, **options)
            counted = slice(-2 * HOLD // COUNTED, None)
            about = {"aim": aim, "parts": kind}
            jumps = rising.flight[counted].max(axis=0) >= LONG_FLIGHT
            scale = rows["acceleration"] * amplitude / (math.pi / half) ** 2
            measures = summarize(rising, counted, half)
            repeating = jumps & repeats(rising.gap[1::2], scale)
            measures |= {"acceleration": amplitude, "repeating": repeating.mean()}
            motions.append(about | measures)
            if kind == AT_REST:
                pushes += [{"aim": aim, **row} for row in push(rows, amplitude, (motion, jumps), settings, **options)]
            falling, _ = follow(rows, amplitudes[fall:], motion, settings, **options)
            path = Path(*(np.concatenate(pair) for pair in zip(rising, falling, strict=True)))
            start += [about | row for row in table_of(path, amplitudes[begin:], ways[begin:], per_row, half)]
    tables = {"start": start, "start_motions": motions, "start_limits": limits, "pushes": pushes}
    return {name: fields.columns(rows, TABLES[name]) for name, rows in tables.items()}
