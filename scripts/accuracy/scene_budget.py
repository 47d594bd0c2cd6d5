"""What the data of each figure need, what that costs, and what a reader would see of less.

Some points of each table that a figure draws are computed as the config says, with the full model at a tight tolerance,
and with variants of both: other tolerances, with the horizontal motion, half the time, a rigid bouncing part in place
of the contact. Drawn values that shifts of the initial height nobody can set (config) change visibly, or an even
tighter tolerance, as in chaos and in long transients, do not count: there the model itself makes no statement.
"""

from collections.abc import Callable
from functools import cache, partial
from time import thread_time
from typing import Any

import numpy as np
import pandas as pd

from accuracy import observables, rigid_part
from accuracy.observables import SHOWN
from conveyor.simulation import simulate
from conveyor.solver.model import unpack
from conveyor.solver.parallel import for_each_chunk
from pipeline import fields, grid

TABLES = {
    "scene_budget": (
        fields.text("figure", "figure of the config"),
        fields.text("table", "table that it draws, SECTION/NAME; none for a drawing"),
        fields.text("needs", "feeding or vertical motion, or nothing"),
        fields.text("shows", "what the figure shows of the table"),
        fields.flag("settled", "whether that is of the motion that a start ends in, not of the way there"),
        fields.text("variant", "full model, feeding or vertical needs, half the time, rigid part, or drawing"),
        fields.number("tolerance", "1", "relative error of a step; null where there is none"),
        fields.number("duration", "s", "length of the runs; null where they last until they settle"),
        fields.count("points", "points of the table that were computed"),
        fields.number("steps", "1/s", "Taylor steps in a second of the motion; null for the rigid part"),
        fields.number("sticks", "1", "share of the points whose part sticks at some time"),
        fields.number("known", "1", "share of the drawn values that a tiny shift of the start does not change visibly"),
        fields.number(
            "changed", "1", "share of those that differ visibly from the full model's, the worst of the columns"
        ),
        fields.flag("visible", "whether a reader would see the difference"),
        fields.flag("chosen", "whether this is what the config chooses"),
        fields.text("reason", "why the choice is tighter than the picture needs; null where it is not"),
    ),
    "budget_times": (
        fields.text("table", "table that a figure draws, SECTION/NAME"),
        fields.text("variant", "as in the table of budgets"),
        fields.number("tolerance", "1", "relative error of a step; null where there is none"),
        fields.number("seconds", "s", "processor time of a point"),
        fields.number("full_seconds", "s", "processor time of a point of the full model at tight tolerance"),
        fields.number("ratio", "1", "the latter over the former"),
    ),
}

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

# Columns of the table of processor times, which differ from run to run.
TIMES = ("table", "variant", "tolerance", "seconds", "full_seconds", "ratio")


def least_time(work: Callable[[], Any]) -> tuple[float, Any]:
    """Least processor time (s) of repeated rounds in this thread, and what `work` returns.

    Other load on the machine only adds to a time.
    """
    times = []
    while not times or (len(times) < ROUNDS and sum(times) < ENOUGH):
        begin = thread_time()
        result = work()
        times.append(thread_time() - begin)
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
    # What is not timed comes first: it loads compiled code.
    alike = observables.observe_shifted(shown, full_settings, budget["shifts"])
    alike.append(shown.observe(full_settings | {"tolerance": TIGHTER}))
    full_seconds, truth = least_time(lambda: shown.observe(full_settings))
    known = observables.known_values(shown, truth, alike, settings["axes"], budget["line"])
    work_at = cache(partial(work_of, parameters[:: max(1, len(parameters) // 50)]))

    def row(variant: str, of: dict, seconds: float, found: pd.DataFrame) -> dict:
        seen = observables.differences(shown, truth, found, settings["axes"], budget["line"])
        shares = [seen[name][known[name]].mean() for name in shown.drawn if known[name].any()]
        steps, sticks = work_at(of["tolerance"])
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
        # As long as starts on the contact are followed, and no shorter than what tells whether a motion repeats itself.
        swept = partial(rigid_part.swept, cycles=max(settings["settling"], 2 * rigid_part.MAX_PERIOD))
        swept(settings | {"axes": observables.thinned(thinned, 1)})
        seconds, found = least_time(lambda: swept(settings))
        rows.append(row(RIGID, settings | {"rigid": True}, seconds, found))
    return rows


def make(
    settings: dict,
    entries: dict[str, dict],
    drawn: dict[str, list[str]],
    *,
    threads: int = 1,
    progress: str | None = None,
) -> dict[str, dict[str, np.ndarray]]:
    """The columns of the table of budgets, rows by figure, table and variant, and of that of their processor times.

    Parameters
    ----------
    settings : the section `scene_budget` of the config
    entries : settings of the tables by their names, SECTION/NAME
    drawn : names of the tables that each figure draws
    threads : on which tables are looked at
    progress : name of a progress bar, or None
    """
    found: dict[str, list[dict]] = {}
    # The longest ones come last: they begin first, so that the threads end together.
    listed = list(entries.items())[::-1]

    def work(begin: int, end: int) -> None:
        for reference, of_table in listed[begin:end]:
            found[reference] = rows_of_table(reference, of_table, settings)

    for_each_chunk(work, len(listed), threads=threads, chunk=1, progress=progress)
    rows = [
        {"figure": figure, **row}
        for figure, references in drawn.items()
        for row in ([one for reference in references for one in found[reference]] if references else [NOTHING])
    ]
    times = [row for reference in entries for row in found[reference]]
    return {
        "scene_budget": {column: np.array([row[column] for row in rows]) for column in ("figure", *NOTHING)},
        "budget_times": {column: np.array([row[column] for row in times]) for column in TIMES},
    }
