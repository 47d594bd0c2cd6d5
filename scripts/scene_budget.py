"""Rule scene_budget: what the data of each figure need, what that costs, and what a reader would see of less.

Some points of each table that a figure draws are computed as the config says, with the full model at a tight tolerance,
and with variants of both: other tolerances, with the horizontal motion, half the time, a rigid bouncing part in place
of the contact. Drawn values that shifts of the initial height nobody can set (config) change visibly, or an even
tighter tolerance, as in chaos and in long transients, do not count: there the model itself makes no statement.
"""

from collections.abc import Callable
from time import perf_counter
from typing import Any

import numpy as np
import pandas as pd
from tqdm import tqdm

import observables
import rigid_part
from conveyor import grid, tables
from conveyor.model import unpack
from conveyor.simulation import simulate
from observables import SHOWN
from rule_log import logged

TIGHT, TIGHTER = 1e-13, 3e-14
ROUNDS, ENOUGH = 3, 0.2  # of a timed run: at most that many, until that many seconds altogether
FULL, HALF, RIGID, DRAWING = "full model", "half the time", "rigid part", "drawing"
NOTHING = {
    "table": "none",
    "needs": "nothing",
    "shows": "a drawing, or numbers from other rules",
    "settled": False,
    "variant": DRAWING,
    "tolerance": np.nan,
    "duration": np.nan,
    "points": 0,
    "steps": 0.0,
    "sticks": np.nan,
    "known": np.nan,
    "changed": 0.0,
    "visible": False,
    "chosen": True,
    "reason": None,
}

# Columns of the table of wall times, which differ from run to run.
TIMES = ("table", "variant", "tolerance", "seconds", "full_seconds", "ratio")


def least_time(work: Callable[[], Any]) -> tuple[float, Any]:
    """Least wall time (s) of repeated rounds, and what `work` returns.

    Other load on the machine only adds to a time.
    """
    times = []
    while not times or (len(times) < ROUNDS and sum(times) < ENOUGH):
        begin = perf_counter()
        result = work()
        times.append(perf_counter() - begin)
    return min(times), result


def variants_of(section: str, settings: dict, tolerances: list[float]) -> list[tuple[str, dict]]:
    """Names and settings of all variants of a table, that of the config first."""
    needs = settings.get("needs", "feeding")
    name = "vertical" if SHOWN[section].vertical else needs
    found = [(name, settings)]
    if section == "impacts":
        return found  # closed forms without a tolerance
    found += [
        (name, settings | {"tolerance": tolerance}) for tolerance in tolerances if tolerance != settings["tolerance"]
    ]
    if needs == "vertical":
        found.append(("feeding", settings | {"needs": "feeding"}))
    if section == "sweeps":
        found.append((HALF, settings | {"duration": 0.5 * settings["duration"]}))
    return found


def work_of(parameters: np.ndarray, tolerance: float) -> tuple[float, float]:
    """Taylor steps of a second of the motion, the mean over the points, and the share of points whose part sticks."""
    runs = [simulate(*unpack(row), tolerance=tolerance) for row in parameters]
    return float(np.mean([run.work for run in runs])), float(np.mean(["stick" in run.events["kind"] for run in runs]))


def rows_of_table(reference: str, settings: dict, budget: dict) -> list[dict]:
    """One row for each variant of one table, SECTION/NAME, with the settings of its entry."""
    section = reference.split("/")[0]
    shown = SHOWN[section]
    needs = "vertical" if shown.vertical else settings.get("needs", "feeding")
    if section == "sweeps" and needs == "vertical":
        shown = shown._replace(drawn=("state",), what="state", settled=True)
    thinned = observables.thinned(settings["axes"], budget["points"][section])
    settings = settings | {"axes": thinned} | budget["shortened"].get(section, {})
    _, parameters = grid.product(settings["axes"], settings["model"])
    full_settings = settings | {"needs": "feeding", "tolerance": TIGHT}
    shown.observe(settings)  # loads compiled code
    full_seconds, truth = least_time(lambda: shown.observe(full_settings))
    alike = [observables.observe_shifted(shown, full_settings, shift) for shift in budget["shifts"]]
    alike.append(shown.observe(full_settings | {"tolerance": TIGHTER}))
    known = observables.known_values(shown, truth, alike, settings["axes"], budget["line"])

    def row(variant: str, of: dict, seconds: float, found: pd.DataFrame) -> dict:
        seen = observables.differences(shown, truth, found, settings["axes"], budget["line"])
        shares = [seen[name][known[name]].mean() for name in shown.drawn if known[name].any()]
        steps, sticks = work_of(parameters[:: max(1, len(parameters) // 50)], of["tolerance"])
        return {
            "table": reference,
            "needs": needs,
            "shows": shown.what,
            "settled": shown.settled,
            "variant": variant,
            "tolerance": np.nan if variant == RIGID or section == "impacts" else of["tolerance"],
            "duration": np.nan if of["duration"] is None else of["duration"],
            "points": len(parameters),
            "seconds": seconds / len(parameters),
            "full_seconds": full_seconds / len(parameters),
            "ratio": full_seconds / seconds,
            "steps": np.nan if variant == RIGID else steps,
            "sticks": sticks,
            "known": float(known.to_numpy().mean()),
            "changed": float(max(shares, default=0.0)),
            "visible": bool(max(shares, default=0.0) > budget["pixels"]),
            "chosen": of is settings,
            "reason": budget["reasons"].get(reference) if of is settings else None,
        }

    rows = [row(FULL, full_settings, full_seconds, truth)]
    for variant, of in variants_of(section, settings, budget["tolerances"]):
        rows.append(row(variant, of, *least_time(lambda of=of: shown.observe(of))))
    if section == "sweeps" and "tension" not in settings["axes"]:
        seconds, found = least_time(lambda: rigid_part.swept(settings))
        rows.append(row(RIGID, settings | {"rigid": True}, seconds, found))
    return rows


def columns(
    entries: dict[str, dict], drawn: dict[str, list[str]], budget: dict, *, progress: str | None = None
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """The columns of the table of budgets, rows by figure, table and variant, and of that of their wall times.

    Parameters
    ----------
    entries : settings of the tables by their names, SECTION/NAME
    drawn : names of the tables that each figure draws
    budget : the section `scene_budget` of the config
    progress : name of a progress bar, or None
    """
    found = {
        reference: rows_of_table(reference, settings, budget)
        for reference, settings in tqdm(entries.items(), desc=progress, unit="tables", disable=progress is None)
    }
    rows = [
        {"figure": figure, **row}
        for figure, references in drawn.items()
        for row in ([one for reference in references for one in found[reference]] if references else [NOTHING])
    ]
    times = [row for of_table in found.values() for row in of_table]
    return (
        {column: np.array([row[column] for row in rows]) for column in ("figure", *NOTHING)},
        {column: np.array([row[column] for row in times]) for column in TIMES},
    )


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        parameters = snakemake.params
        verdicts, times = columns(parameters.entries, parameters.drawn, parameters.budget, progress="scene budget")
        tables.write(snakemake.output.table, "scene_budget", verdicts, settings=parameters.budget)
        tables.write(snakemake.output.times, "budget_times", times, settings=parameters.budget)
