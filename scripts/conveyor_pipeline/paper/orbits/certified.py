"""Computer-assisted proofs of periodic orbits, bifurcations and chaos that were found in floating point."""

import itertools
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from multiprocessing import get_context
from typing import NamedTuple

import numpy as np
import pandas as pd
from flint import arb
from pyarrow import Field

from conveyor import Bifurcation, Orbit, find_doubled_orbit, replace_parameters
from conveyor.analysis.bifurcations.continuation import follow_branch
from conveyor.analysis.bifurcations.periodic_orbits import SAME_ORBIT, ReturnMap, orbit_near
from conveyor.certificates import (
    Accuracy,
    Horseshoe,
    Law,
    ProvedOrbit,
    Refused,
    Shooting,
    System,
    bounds,
    bracket_doubling,
    bracket_fold,
    check_near,
    exactly,
    law_of,
    plan_sets,
    precision,
    prove_horseshoe,
    prove_orbit,
)
from conveyor.progress import progress_bar
from conveyor_pipeline.common import fields, grid


def bounds_fields(name: str, unit: str, description: str) -> tuple[Field, Field]:
    """Two columns: proved bounds of a number, rounded outwards."""
    return (
        fields.number(f"{name}_low", unit, f"{description}: proved lower bound; null where nothing is proved"),
        fields.number(f"{name}_high", unit, f"{description}: proved upper bound"),
    )


ARITHMETIC = (
    fields.count("bits", "bits of the arithmetic"),
    fields.count("order", "order of the Taylor series"),
)
TABLES = {
    "certificates": (
        fields.count("branch", "number of the branch; above all stored ones for longer orbits of the cascade"),
        fields.count("period", "excitation cycles; the least period, if the orbit is proved"),
        fields.number("acceleration", "m/s²", "amplitude of the excitation, exact as a decimal number"),
        fields.flag("contained", "whether exactly one orbit is proved in a box around the stored one"),
        fields.text("reason", "reason why the proof failed; null if it is proved"),
        fields.text("stability", "proved stability: stable or unstable; open if not proved"),
        fields.count("impacts", "impacts in a period, proved if the orbit is"),
        fields.number("stored_delta", "m", "penetration at the phase ψ0 of the orbit in floating point"),
        fields.number("stored_v", "m/s", "speed of approach at the phase ψ0 of the orbit in floating point"),
        *bounds_fields("delta", "m", "penetration at the phase ψ0"),
        *bounds_fields("v", "m/s", "speed of approach at the phase ψ0"),
        *bounds_fields("impact_phase", "rad", "phase of the first impact after ψ0"),
        *bounds_fields("impact_speed", "m/s", "speed of approach at the first impact"),
        *bounds_fields("duration", "s", "period"),
        *bounds_fields("contact_time", "s", "time with contact force in a period"),
        *bounds_fields("trace", "1", "sum of the Floquet multipliers"),
        *bounds_fields("determinant", "1", "product of the Floquet multipliers, exp(-(d_c/m) contact_time)"),
        *bounds_fields("multiplier_1_real", "1", "multiplier of larger modulus, real part; null if unknown which"),
        *bounds_fields("multiplier_1_imag", "1", "multiplier of larger modulus, imaginary part"),
        *bounds_fields("multiplier_2_real", "1", "multiplier of smaller modulus, real part"),
        *bounds_fields("multiplier_2_imag", "1", "multiplier of smaller modulus, imaginary part"),
        fields.number("half_width", "1", "largest half-width of an enclosure of a state, in g/ω² and g/ω"),
        fields.number("distance", "1", "distance of the stored orbit from the enclosed one, in g/ω² and g/ω"),
        *ARITHMETIC,
    ),
    "certified_bifurcations": (
        fields.text("kind", "fold or period_doubling"),
        fields.count("number", "number of the bifurcation among all of its kind"),
        fields.count("period", "excitation cycles of the orbit that folds or doubles"),
        fields.flag("proved", "whether the bifurcation is proved"),
        fields.text("reason", "reason why the proof failed; null if it is proved"),
        fields.number("stored_acceleration", "m/s²", "amplitude in floating point"),
        *bounds_fields("acceleration", "m/s²", "amplitude of the bifurcation"),
        *bounds_fields("test_begin", "1", "(1 ∓ μ1)(1 ∓ μ2) of a fold (-) or doubling (+) at the bracket's first end"),
        *bounds_fields("test_end", "1", "the same test at the bracket's last end"),
        *ARITHMETIC,
    ),
    "certified_chaos": (
        fields.number("acceleration", "m/s²", "amplitude of the excitation, exact as a decimal number"),
        fields.flag("proved", "whether covering relations that imply chaos are proved"),
        fields.text("reason", "reason why the proof failed; null if they are proved"),
        fields.count("sets", "number of parallelograms, and of excitation cycles of an excursion from the first one"),
        fields.number("entropy", "1", "topological entropy per excitation cycle, proved lower bound"),
        fields.number("delta", "m", "penetration at the phase ψ0 of the orbit of one cycle in the first parallelogram"),
        fields.number("v", "m/s", "speed of approach at the phase ψ0 of that orbit"),
        *ARITHMETIC,
    ),
    "certificate_times": (
        fields.text("kind", "table of the certificate"),
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.count("period", "excitation cycles"),
        fields.count("impacts", "impacts in a period"),
        fields.number("seconds", "s", "processor time, which differs between runs"),
    ),
}


class Arithmetic(NamedTuple):
    """The arithmetic of proofs."""

    bits: int
    order: int  # of the Taylor series
    tolerance: float  # of the last terms of the series, in g/ω² and g/ω


EXACT = Arithmetic(bits=128, order=32, tolerance=1e-22)
# A horseshoe needs no narrow enclosures.
CHAOS = Arithmetic(bits=64, order=24, tolerance=1e-14)
LONGEST_PERIOD = 16  # cycles; orbits longer than orbits.max_period belong to the cascade of the jumping orbit
CLOSENESS = 1e-7  # in g/ω² and g/ω; a proved orbit at a larger distance from the stored orbit is a different one
HALF_WIDTH = 1e-10  # m/s², of the bracket of a period doubling
HALF_ARC = 1e-6  # in g/ω², g/ω and g: half the length of the arc around a fold
# Of the first parallelogram of a horseshoe: largest half axis in the unstable direction, in g/ω² and g/ω, and ratio of
# the half axes, unstable to stable.
SIZE, RATIO = 1e-6, 0.3
LONGEST_EXCURSION = 14  # cycles, without approach and return
MOST_EXCURSIONS = 4  # of a saddle that are tried, the shortest first; some cannot be proved


class Line(NamedTuple):
    """A branch in floating point: period (cycles) and points (δ in m, v in m/s, â in m/s²) in order, shape (n, 3)."""

    period: int
    points: np.ndarray


class FloatOrbit(NamedTuple):
    """An orbit in floating point."""

    branch: int
    orbit: Orbit
    strobes: np.ndarray  # (δ, Y) at the beginnings of its cycles in units of the law, shape (period, 2)


class Task(NamedTuple):
    """A proof: the kind of its table, and the arguments of the function in PROVERS besides the settings."""

    kind: str
    arguments: tuple


def law(settings: dict) -> Law:
    """The conveyor with its parameters as exact decimal numbers."""
    return law_of(grid.conveyor_and_start(settings["model"])[0])


def shooting(settings: dict, period: int) -> Shooting:
    """The equations of orbits with a period."""
    return Shooting(law(settings), Accuracy(EXACT.order, EXACT.tolerance), period)


def float_orbit(branch: int, returns: ReturnMap, unknown: np.ndarray) -> FloatOrbit:
    """The orbit of a fixed point of a return map."""
    later = returns.strobes(unknown)[:-1, :2]
    return FloatOrbit(branch, returns.describe(unknown), np.vstack([unknown[:2], later]))


def orbits_at(parameters: np.ndarray, branch: int, line: Line, acceleration: float) -> list[FloatOrbit]:
    """The different orbits of a branch at an amplitude. A branch may pass one orbit at several of its cycles.

    If Newton's method finds no orbit between two points of the branch, their interpolation is used; its proof then
    fails with a reason.
    """
    returns = ReturnMap(parameters, line.period)
    orbits = []
    above = line.points[:, 2] > acceleration
    for i in np.flatnonzero(above[1:] != above[:-1]):
        begin, end = line.points[i : i + 2]
        point = begin + (acceleration - begin[2]) / (end[2] - begin[2]) * (end - begin)
        guess = returns.scaled(acceleration, point[:2])
        unknown = returns.newton(guess)
        unknown = guess if unknown is None else unknown
        distances = [np.abs(other.strobes - unknown[:2]).max(axis=1).min() for other in orbits]
        if min(distances, default=np.inf) > SAME_ORBIT:
            orbits.append(float_orbit(branch, returns, unknown))
    return orbits


def stored_lines(table: pd.DataFrame, longest_period: int) -> dict[int, Line]:
    """The branches of the table `branches` up to a period, by number."""
    last = table[(table.cycle == table.period) & (table.period <= longest_period)].sort_values(["branch", "point"])
    return {
        int(number): Line(int(rows.period.iloc[0]), rows[["delta", "v", "acceleration"]].to_numpy())
        for number, rows in last.groupby("branch")
    }


def doubled_lines(
    parameters: np.ndarray, cascade: pd.DataFrame, longest: tuple[int, int], limits: tuple[float, float]
) -> list[Line]:
    """Branches of the cascade whose periods are longer than the stored ones, up to the longest one to prove."""
    lines = []
    for row in cascade.itertuples():
        period = 2 * int(row.period)
        if longest[0] < period <= longest[1] and limits[0] < row.acceleration < limits[1]:
            at_doubling = replace_parameters(parameters, acceleration=row.acceleration)
            orbit = orbit_near(at_doubling, np.array([row.delta, row.v]), int(row.period))
            doubled = find_doubled_orbit(Bifurcation("period_doubling", orbit, -1.0, "acceleration"))
            branch = follow_branch(doubled, "acceleration", limits).orbits
            lines.append(Line(period, np.array([[*orbit.state, orbit.acceleration] for orbit in branch])))
    return lines


def orbits_to_prove(settings: dict, branches: pd.DataFrame, cascade: pd.DataFrame) -> list[FloatOrbit]:
    """All orbits up to the longest period at the amplitudes of the settings, by amplitude."""
    parameters = grid.row_of(settings["model"])
    chosen = sorted({*grid.axis_values("acceleration", settings["acceleration"]).tolist(), *settings["also"]})
    lines = stored_lines(branches, LONGEST_PERIOD)
    periods = int(branches.period.max()), LONGEST_PERIOD
    doubled = doubled_lines(parameters, cascade, periods, (chosen[0], settings["doubled_limit"]))
    lines |= dict(enumerate(doubled, start=int(branches.branch.max()) + 1))
    return [
        orbit
        for acceleration in chosen
        for number, line in lines.items()
        for orbit in orbits_at(parameters, number, line, acceleration)
    ]


def bounds_columns(name: str, ball: arb, unit: arb | int = 1) -> dict[str, float]:
    """Columns NAME_low and NAME_high with the bounds of a ball in a unit, rounded outwards."""
    low, high = bounds(ball * unit)
    return {f"{name}_low": low, f"{name}_high": high}


def certificate_columns(units: Law, orbit: ProvedOrbit) -> dict[str, float]:
    """The columns with the bounds of a proved orbit."""
    delta, y = orbit.strobe(0)
    v = y - units.beta * delta if delta > 0 else y
    columns = bounds_columns("delta", delta, units.length) | bounds_columns("v", v, units.speed)
    columns |= bounds_columns("duration", orbit.duration / units.omega)
    columns |= bounds_columns("contact_time", orbit.contact / units.omega)
    columns |= bounds_columns("trace", orbit.trace) | bounds_columns("determinant", orbit.determinant)
    for phase, speed in orbit.impacts[:1]:
        columns |= bounds_columns("impact_phase", phase) | bounds_columns("impact_speed", speed, units.speed)
    with suppress(Refused):
        for number, (real, imag) in enumerate(orbit.multipliers(), start=1):
            columns |= bounds_columns(f"multiplier_{number}_real", real)
            columns |= bounds_columns(f"multiplier_{number}_imag", imag)
    return columns


def prove_float_orbit(settings: dict, unproved: FloatOrbit) -> dict:
    """The row of one orbit."""
    stored = unproved.orbit
    problem = shooting(settings, unproved.orbit.period)
    row = {
        "branch": unproved.branch,
        "acceleration": stored.acceleration,
        "period": stored.period,
        "stored_delta": stored.state[0],
        "stored_v": stored.state[1],
        "contained": False,
        "impacts": stored.impacts,
        "stability": "open",
    }
    try:
        orbit = prove_orbit(problem, problem.law.gamma(exactly(stored.acceleration)), unproved.strobes)
        distance = check_near(orbit, unproved.strobes, CLOSENESS)
    except Refused as refused:
        return row | {"reason": str(refused)}
    return {
        **row,
        **certificate_columns(problem.law, orbit),
        "contained": True,
        "reason": None,
        "impacts": len(orbit.impacts),
        "stability": orbit.stability,
        "half_width": orbit.half_width,
        "distance": distance,
    }


def prove_bifurcation(settings: dict, kind: str, number: int, row: dict) -> dict:
    """The row of one fold or period doubling, given by its kind, number and row in a table."""
    period, stored = row["period"], row["acceleration"]
    problem = shooting(settings, period)
    returns = ReturnMap(grid.row_of(settings["model"]), period)
    strobes = float_orbit(0, returns, returns.scaled(stored, np.array([row["delta"], row["v"]]))).strobes
    about = {"kind": kind, "number": number, "period": period, "stored_acceleration": stored}
    try:
        if kind == "fold":
            bracket = bracket_fold(problem, stored, strobes, HALF_ARC)
        else:
            bracket = bracket_doubling(problem, stored, strobes, HALF_WIDTH)
    except Refused as refused:
        return about | {"proved": False, "reason": str(refused)}
    begin, end = bracket.tests
    return {
        **about,
        "proved": True,
        "reason": None,
        **bounds_columns("acceleration", bracket.acceleration),
        **bounds_columns("test_begin", begin),
        **bounds_columns("test_end", end),
    }


def prove_shortest(system: System, plans: Iterator[tuple[np.ndarray, list[np.ndarray]]]) -> Horseshoe:
    """The first of MOST_EXCURSIONS planned horseshoes that can be proved.

    Refused with the reason of the last one if none can.
    """
    reason = ""
    for centres, axes in itertools.islice(plans, MOST_EXCURSIONS):
        try:
            return prove_horseshoe(system, centres, axes)
        except Refused as refused:
            reason = str(refused)
    raise Refused(reason)


def prove_chaos(settings: dict, acceleration: float, saddles: list[FloatOrbit]) -> dict:
    """The row of one amplitude: a horseshoe at an unstable orbit of one cycle.

    Orbits are tried in the order of their multipliers, the largest one first.
    """
    parameters = grid.row_of(settings["model"])
    units = law(settings)
    system = System(units, units.gamma(exactly(acceleration)), Accuracy(CHAOS.order, CHAOS.tolerance))
    row = {
        "acceleration": acceleration,
        "proved": False,
        "reason": "there is no unstable orbit of one cycle",
        "sets": 0,
    }
    for saddle in sorted(saddles, key=lambda saddle: -abs(saddle.orbit.multipliers[0])):
        try:
            fixed = np.append(saddle.strobes[0], acceleration)
            horseshoe = prove_shortest(system, plan_sets(parameters, fixed, SIZE, RATIO, LONGEST_EXCURSION))
        except Refused as refused:
            row["reason"] = str(refused)
            continue
        return {
            **row,
            "proved": True,
            "reason": None,
            "sets": len(horseshoe.sets),
            "entropy": bounds(horseshoe.entropy)[0],
            "delta": saddle.orbit.state[0],
            "v": saddle.orbit.state[1],
        }
    return row


PROVERS = {
    "certificates": prove_float_orbit,
    "certified_bifurcations": prove_bifurcation,
    "certified_chaos": prove_chaos,
}


def run_task(settings: dict, task: Task) -> tuple[dict, float]:
    """The row of a proof, with NaN for what it does not prove, and its processor time (s)."""
    begin = time.process_time()
    arithmetic = CHAOS if task.kind == "certified_chaos" else EXACT
    with precision(arithmetic.bits, arithmetic.order):
        row = PROVERS[task.kind](settings, *task.arguments)
    unknown = dict.fromkeys((column.name for column in TABLES[task.kind]), np.nan)
    row = {**unknown, **row, "bits": arithmetic.bits, "order": arithmetic.order}
    return row, time.process_time() - begin


def run_tasks(settings: dict, tasks: list[Task], processes: int) -> list[tuple[dict, float]]:
    """The rows of all proofs with their processor times (s), in order, from several processes."""
    with ProcessPoolExecutor(processes, mp_context=get_context("fork")) as pool:
        # The longest proofs come last in the list and are started first, so that all processes end together.
        futures = [pool.submit(run_task, settings, task) for task in reversed(tasks)]
        return [future.result() for future in progress_bar(futures, label="certificates", unit="proofs")][::-1]


def list_tasks(settings: dict, branches: pd.DataFrame, bifurcations: pd.DataFrame, cascade: pd.DataFrame) -> list[Task]:
    """All proofs."""
    first = cascade.iloc[0]
    doublings = bifurcations[(bifurcations.kind == "period_doubling") & (bifurcations.period == first.period)]
    jumping = doublings.loc[(doublings.acceleration - first.acceleration).abs().idxmin()].branch
    folds = bifurcations[(bifurcations.kind == "fold") & (bifurcations.branch == jumping)]
    parameters = grid.row_of(settings["model"])
    singles = stored_lines(branches, 1)
    tasks = [Task("certificates", (orbit,)) for orbit in orbits_to_prove(settings, branches, cascade)]
    for kind, rows in (("fold", folds), ("period_doubling", cascade.head(settings["doublings"]))):
        for number, row in enumerate(rows.to_dict("records"), start=1):
            tasks.append(Task("certified_bifurcations", (kind, number, row)))
    for acceleration in settings["chaos"]["acceleration"]:
        orbits = [orbits_at(parameters, number, line, acceleration) for number, line in singles.items()]
        saddles = [candidate for candidate in itertools.chain(*orbits) if abs(candidate.orbit.multipliers[0]) > 1.0]
        tasks.append(Task("certified_chaos", (acceleration, saddles)))
    return tasks


def make(
    settings: dict,
    branches: pd.DataFrame,
    folds_and_doublings: pd.DataFrame,
    cascade: pd.DataFrame,
    *,
    threads: int = 1,
) -> dict[str, dict[str, np.ndarray]]:
    """The columns of the four tables, by their kinds, for the section `certificates` of the config."""
    tasks = list_tasks(settings, branches, folds_and_doublings, cascade)
    rows: dict[str, list[dict]] = {kind: [] for kind in TABLES}
    for task, (row, seconds) in zip(tasks, run_tasks(settings, tasks, threads), strict=True):
        rows[task.kind].append(row)
        rows["certificate_times"].append(
            {
                "kind": task.kind,
                "acceleration": row.get("acceleration", row.get("stored_acceleration")),
                "period": row.get("period", 1),
                "impacts": row.get("impacts", 0),
                "seconds": seconds,
            }
        )
    return {kind: fields.columns(rows_of_kind, TABLES[kind]) for kind, rows_of_kind in rows.items()}
