"""Cost and visible effect of cheaper variants of the table behind each figure.

Some points of each table are computed with the settings of the config, with the full model at a tight tolerance, and
with variants: other tolerances, with the horizontal motion, half the duration, a practically rigid part. Some drawn
values change visibly with tiny shifts of the initial height or with an even tighter tolerance, as in chaos and in long
transients. They do not count, because the model itself makes no statement about them.
"""

from functools import partial

import numpy as np
import pandas as pd

from conveyor import conveyor_and_start, simulate
from conveyor.parallel import for_each_chunk
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.study.accuracy import observables
from conveyor_pipeline.study.accuracy.limits import PIXELS
from conveyor_pipeline.study.accuracy.observables import SHOWN
from conveyor_pipeline.study.accuracy.timing import run_in_turns

TABLES = {
    "scene_budget": (
        fields.text("figure", "figure of the config"),
        fields.text("table", "table behind the figure, SECTION/NAME; none for a drawing"),
        fields.text("needs", "feeding or vertical motion, or nothing"),
        fields.text("shows", "drawn quantities of the table"),
        fields.text("variant", "full model, feeding or vertical needs, half the time, rigid part, or drawing"),
        fields.number("tolerance", "1", "relative error of a step; null where there is none"),
        fields.count("points", "computed points of the table"),
        fields.number("sticks", "1", "share of the points whose part sticks at some time"),
        fields.number("known", "1", "share of the drawn values without a visible change by a tiny shift of the height"),
        fields.number("changed", "1", "share of values that differ visibly from the full model, for the worst column"),
        fields.flag("visible", "whether a reader would see the difference"),
        fields.flag("chosen", "whether the config chooses this variant"),
        fields.text("reason", "reason for a choice that is tighter than necessary; null for none"),
    ),
    "budget_times": (
        fields.text("table", "table behind a figure, SECTION/NAME"),
        fields.text("variant", "as in the table of budgets"),
        fields.number("tolerance", "1", "relative error of a step; null where there is none"),
        fields.number("seconds", "s", "processor time of a point"),
    ),
}

TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)  # a table is compared at the ones looser than its own
TIGHT, TIGHTER = 1e-13, 3e-14
# Excitation cycles of each variant and before the first sample of a portrait; number of samples of a portrait.
CYCLES, SAMPLES = 1000, 20000
HARDER = 1e6  # stiffness of a practically rigid part in units of the table's; its impacts are 250 times shorter
SHIFTS = (1e-11, -1e-11, 2e-11)  # of the initial height, m: a tenth of an atom
FEW = 10  # the share of the points with which code is loaded is 1/FEW: enough for all that many points use
REPEATS, SECONDS = 3, 0.05  # rounds of timed runs, and seconds after which a run is not repeated
FULL, HALF, RIGID, DRAWING = "full model", "half the time", "rigid part", "drawing"
NOTHING = {
    "table": "none",
    "needs": "nothing",
    "shows": "a drawing, or numbers from other rules",
    "variant": DRAWING,
    "tolerance": np.nan,
    "points": 0,
    "sticks": np.nan,
    "known": np.nan,
    "changed": 0.0,
    "visible": False,
    "chosen": True,
    "reason": None,
}


def harden(model: dict) -> dict:
    """A model with a contact so stiff that impacts take nearly no time, with the same restitution at each speed."""
    damping = model["damping"] * HARDER ** (1.0 / (1.0 + model["exponent"]))
    return model | {"stiffness": HARDER * model["stiffness"], "damping": damping}


def variants_of(section: str, settings: dict) -> list[tuple[str, dict]]:
    """Names and settings of all variants of a table; the config's own variant comes first.

    A tolerance that is tighter than the config's is neither cheaper nor needed to judge the choice.
    """
    needs = settings.get("needs", "feeding")
    name = "vertical" if SHOWN[section].vertical else needs
    variants = [(name, settings)]
    if section == "impacts":
        return variants  # closed forms have no tolerance
    looser = [tolerance for tolerance in TOLERANCES if tolerance > settings["tolerance"]]
    variants += [(name, settings | {"tolerance": tolerance}) for tolerance in looser]
    if needs == "vertical":
        variants.append(("feeding", settings | {"needs": "feeding"}))
    if section == "sweeps":
        variants.append((HALF, settings | {"duration": 0.5 * settings["duration"]}))
        variants.append((RIGID, settings | {"model": harden(settings["model"])}))
    return variants


def share_that_sticks(parameters: np.ndarray, tolerance: float) -> float:
    """The share of points whose part sticks at some time."""
    runs = [simulate(*conveyor_and_start(row), tolerance=tolerance) for row in parameters]
    return float(np.mean(["stick" in run.events["kind"] for run in runs]))


def rows_of_table(reference: str, settings: dict, budget: dict) -> list[dict]:
    """The rows of a table, SECTION/NAME, one for each variant, from the settings of its entry."""
    section = reference.split("/")[0]
    shown = SHOWN[section]
    needs = "vertical" if shown.vertical else settings.get("needs", "feeding")
    if section == "sweeps" and needs == "vertical":
        shown = shown._replace(drawn=("state",), what="state")
    thinned = observables.thin_axes(settings["axes"], budget["points"][section])
    _, parameters = grid.product(thinned, settings["model"])
    settings = settings | {"axes": thinned, "settling": CYCLES}
    if section == "dimensions":
        settings["samples"] = SAMPLES
    full_settings = settings | {"needs": "feeding", "tolerance": TIGHT}
    # Runs without timing come first, because they compile or load all code that the variants use.
    shown.observe(settings | {"axes": observables.thin_axes(thinned, budget["points"][section] // FEW)})
    alike = observables.observe_shifted(shown, full_settings, SHIFTS)
    alike.append(shown.observe(full_settings | {"tolerance": TIGHTER}))
    variants = [(FULL, full_settings), *variants_of(section, settings)]
    runs = [partial(shown.observe, variant_settings) for _, variant_settings in variants]
    observed, times = run_in_turns(runs, repeats=REPEATS, seconds=SECONDS)
    truth = observed[0]
    robust = observables.robust_values(shown, truth, alike, settings["axes"])
    sticks = share_that_sticks(parameters[:: max(1, len(parameters) // 50)], settings["tolerance"])

    def row(variant: str, variant_settings: dict, seconds: float, table: pd.DataFrame) -> dict:
        visible = observables.visible_differences(shown, truth, table, settings["axes"])
        shares = [visible[name][robust[name]].mean() for name in shown.drawn if robust[name].any()]
        return {
            "table": reference,
            "needs": needs,
            "shows": shown.what,
            "variant": variant,
            "tolerance": np.nan if section == "impacts" else variant_settings["tolerance"],
            "points": len(parameters),
            "seconds": seconds / len(parameters),
            "sticks": sticks,
            "known": float(robust.to_numpy().mean()) if robust.size else np.nan,
            "changed": float(max(shares, default=0.0)),
            "visible": bool(max(shares, default=0.0) > PIXELS),
            "chosen": variant_settings is settings,
            "reason": budget["reasons"].get(reference) if variant_settings is settings else None,
        }

    return [
        row(variant, variant_settings, float(np.median(spent)), table)
        for (variant, variant_settings), spent, table in zip(variants, times, observed, strict=True)
    ]


def make(
    settings: dict,
    entries: dict[str, dict],
    drawn: dict[str, list[str]],
    *,
    threads: int = 1,
    progress: str | None = None,
) -> dict[str, dict[str, list]]:
    """The columns of the table of budgets, by figure, table and variant, and of the table of processor times.

    entries : settings of the tables by name, SECTION/NAME
    drawn : names of the tables behind each figure
    """
    rows_by_table: dict[str, list[dict]] = {}
    # The slowest tables come last in the config and are started first, so that all threads end together.
    listed = list(entries.items())[::-1]

    def work(begin: int, end: int) -> None:
        for reference, entry in listed[begin:end]:
            rows_by_table[reference] = rows_of_table(reference, entry, settings)

    for_each_chunk(work, len(listed), threads=threads, chunk=1, progress=progress)
    rows = [
        {"figure": figure, **row}
        for figure, references in drawn.items()
        for row in ([row for reference in references for row in rows_by_table[reference]] if references else [NOTHING])
    ]
    times = [row for reference in entries for row in rows_by_table[reference]]
    return {
        "scene_budget": fields.columns(rows, TABLES["scene_budget"]),
        "budget_times": fields.columns(times, TABLES["budget_times"]),
    }
