"""The settings of each table: the part of the config that its script needs, as a pure function of the config.

The rule that makes a table passes its settings to the script, which stores them in the table. A rule that reads the
table expects the same settings, so a table that was made from other settings is refused.
"""

import itertools
import math

from scripts.identification.settings import identification_settings

from .sharing import THREADS, plan, seconds_of
from .tables import ENTRIES, entry_of, kind_of, resolve, roles_of_solution, tighter_reference


def settings_of(config: dict, reference: str) -> dict | None:
    """The settings of the table SECTION/NAME, or None for a table that is made from other tables only."""
    section, name = reference.split("/", maxsplit=1)
    match section, name:
        case "regressions", _:
            return config["regressions"][name]
        case _ if section in ENTRIES:
            return resolve(config, section, name)
        case (("precision" | "precision_times"), _):
            return precision_settings(config, name)
        case "orbits", ("branches" | "folds_and_doublings" | "cascade"):
            return analysis_settings(config, "orbits")
        case "orbits", _:
            return {**config["certificates"], "model": analysis_settings(config, "orbits")["model"]}
        case "attractors", _:
            return analysis_settings(config, "attractors")
        case "lyapunov", "spectrum":
            return analysis_settings(config, "attractors", "lyapunov")
        case "lyapunov", _:
            return analysis_settings(config, "attractors", "witnesses")
        case "sensitivity", ("derivatives" | "groups"):
            return {name: value for name, value in sensitivity_settings(config).items() if name != "curves"}
        case "sensitivity", _:
            return {name: sensitivity_settings(config)[name] for name in ("longest_period", "curves", "model")}
        case "operating", "shares":
            return operating_settings(config)
        case "operating", _:
            return None
        case "identification", _:
            return identification_settings(config, name, model_without_acceleration(config))
        case "results", "benchmark":
            return benchmark_settings(config)
        case "results", "stability_estimates":
            return {**config[name], "model": model_without_acceleration(config)}
        case "results", "settling_times":
            solver = {key: config["solver"][key] for key in ("settling", "tolerance")}
            return {**config[name], **solver, "model": model_without_acceleration(config)}
        case "results", "budget_times":
            return config["scene_budget"]
        case "results", "claims":
            return {"claims": config["claims"]}
        case "results", _:
            return config[name]
    raise ValueError(f"{reference} is not a table of the config")


def model_without_acceleration(config: dict) -> dict:
    """The model for sections that state their amplitudes, so that the default amplitude does not rerun them."""
    return {name: value for name, value in config["model"].items() if name != "acceleration"}


def analysis_settings(config: dict, *sections: str) -> dict:
    """Sections of the analysis merged with the tolerance and the model; later sections win."""
    settings = {"tolerance": config["solver"]["tolerance"]}
    if "attractors" in sections:
        settings["settling"] = config["solver"]["settling"]
    for section in sections:
        settings.update(config[section])
    return {**settings, "model": {**model_without_acceleration(config), **settings.get("model", {})}}


def sensitivity_settings(config: dict) -> dict:
    return {**config["sensitivity"], "model": analysis_settings(config, "orbits")["model"]}


def operating_settings(config: dict) -> dict:
    """The operating section states the amplitudes and the box of initial conditions."""
    initial = ("psi0", "z0", "vz0")
    model = {name: value for name, value in model_without_acceleration(config).items() if name not in initial}
    return {**config["operating"], "settling": config["solver"]["settling"], "model": model}


# -- accuracy ----------------------------------------------------------------------------------------------------------


def precision_settings(config: dict, scene: str) -> dict:
    """One scene of the section `precision`."""
    precision = config["precision"]
    shared = {name: precision[name] for name in ("duration", "tolerances", "steps", "peers", "max_evaluations")}
    return {**shared, "model": {**config["model"], **precision["scenes"][scene]}}


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


def budgeted_tables(config: dict) -> dict[str, list[str]]:
    """The tables of converged trajectories that each figure draws and that the section `scene_budget` covers."""

    def is_budgeted(reference: str) -> bool:
        section = reference.split("/")[0]
        entry = entry_of(config, reference)
        is_converged = entry.get("method", "event") == "event"
        return section in config["scene_budget"]["points"] and kind_of(reference) != "witnesses" and is_converged

    return {
        figure: [reference for reference in dict.fromkeys(entry["tables"].values()) if is_budgeted(reference)]
        for figure, entry in config["figures"].items()
    }


def budgeted_entries(config: dict) -> dict[str, dict]:
    """The settings of all budgeted tables, each with an axis over the amplitude."""
    entries = {}
    for reference in itertools.chain(*budgeted_tables(config).values()):
        entry = settings_of(config, reference)
        if "axes" not in entry:
            entry = {**entry, "axes": {"acceleration": entry["acceleration"]}, "duration": None}
        entries[reference] = entry
    return entries


def scaling_case(config: dict, varied: str, axes: dict, *, shards=None, threads=THREADS, conveyors=1) -> dict:
    """A sweep of the chart of scaling, in the planned number of shards unless `shards` is given."""
    own = {"axes": axes, "needs": "vertical", "duration": 0.02, "tolerance": 1.0e-6}
    entry = resolve(config | {"sweeps": {varied: own}}, "sweeps", varied)
    if conveyors > 1:
        entry["model"] |= {"z0": 0.0}
    shared = plan(config["sharing"], entry)
    if shards:
        rows = math.ceil(shared.points / shards)
        seconds = seconds_of(entry, config["sharing"]["seconds"], rows)
        shared = shared._replace(rows=rows, shards=math.ceil(shared.points / rows), seconds=seconds)
    is_whole = shards or shared.points <= config["scaling"]["made_whole"]
    return {
        "varied": varied,
        "settings": entry,
        "plan": shared._asdict(),
        "threads": threads,
        "conveyors": conveyors,
        "measured": shared.shards if is_whole else 1,
    }


def map_axes(points: int) -> dict:
    """Axes of a map of about `points` initial conditions, as in Fig. 13."""
    phases = round(points**0.5)
    z0 = {"start": 0.0, "stop": 0.5e-3, "num": points // phases}
    return {"psi0": {"start": 0.0, "stop": 2.0 * math.pi * (1.0 - 1.0 / phases), "num": phases}, "z0": z0}


def scaling_cases(config: dict) -> list[dict]:
    """All sweeps of the chart of scaling."""
    scaling = config["scaling"]
    few = map_axes(scaling["shared_points"])
    amplitudes = [{"start": 20.0, "stop": 45.0, "num": number} for number in scaling["conveyors"]]
    return [
        *(scaling_case(config, "points", map_axes(points)) for points in scaling["points"]),
        *(scaling_case(config, "conveyors", {"acceleration": axis}, conveyors=axis["num"]) for axis in amplitudes),
        *(scaling_case(config, "threads", few, shards=1, threads=threads) for threads in scaling["threads"]),
        *(scaling_case(config, "shards", few, shards=shards) for shards in scaling["shards"]),
    ]


# -- claims ------------------------------------------------------------------------------------------------------------


def tighter_claims(config: dict) -> dict[str, dict]:
    """The claims whose uncertainty is estimated, with tables of tighter tolerances for the converged solution."""

    def tighten(claim: dict) -> dict:
        tables = claim["tables"]
        tighter = {role: tighter_reference(config, tables[role]) for role in roles_of_solution(tables)}
        return claim | {"tables": tables | tighter}

    return {name: tighten(config["claims"][name]) for name in config["uncertainty"]["claims"]}
