"""The tables of a config, and the settings of each table: the part of the config that its script needs.

The rule that makes a table passes its settings to the script, which stores them in the table. A rule that reads the
table expects the same settings, so a table that was made from other settings is refused.
"""

import itertools
import math
from functools import partial
from operator import itemgetter

from scripts.identification.settings import IDENTIFICATION, identification_settings

from .entries import ENTRIES, fill_defaults, resolve, roles_of_solution, tighter_reference, without_tangential
from .sharing import THREADS, plan, seconds_of


def model_without_acceleration(config: dict) -> dict:
    """The model for sections that state their amplitudes, so that the default amplitude does not rerun them."""
    return {name: value for name, value in config["model"].items() if name != "acceleration"}


def with_model(config: dict, *sections: str, solver: tuple[str, ...] = ()) -> dict:
    """Settings of the solver and sections of the config, of which later ones win, with the model."""
    settings = {key: config["solver"][key] for key in solver}
    for section in sections:
        settings |= config[section]
    return {**settings, "model": {**model_without_acceleration(config), **settings.get("model", {})}}


def with_normal_model(config: dict, *sections: str, solver: tuple[str, ...] = ()) -> dict:
    """The same for tables that follow from the motion normal to the track alone."""
    settings = with_model(config, *sections, solver=solver)
    return settings | {"model": without_tangential(settings["model"])}


def sensitivity_settings(config: dict) -> dict:
    return {**config["sensitivity"], "model": with_model(config, "orbits")["model"]}


def operating_settings(config: dict) -> dict:
    """The operating section states the amplitudes and the box of initial conditions."""
    initial = ("psi0", "z0", "vz0")
    model = {name: value for name, value in model_without_acceleration(config).items() if name not in initial}
    return {**config["operating"], "settling": config["solver"]["settling"], "model": model}


def of_box(section: str, config: dict) -> dict:
    """A section that follows the initial conditions of the operating section's box, at other conveyors."""
    own = {key: value for key, value in operating_settings(config).items() if key not in ("acceleration", "resolution")}
    own = own | config[section]
    return {**own, "model": {name: value for name, value in own["model"].items() if name not in config[section]}}


def drive_settings(config: dict) -> dict:
    """The drive's searched parameters come from the bounds, and the error of its amplitude from the advice."""
    own = {**of_box("drive", config), "margin": config["advice"]["margin"]}
    return {**own, "model": {name: value for name, value in own["model"].items() if name not in own["bounds"]}}


def precision_settings(config: dict, scene: str) -> dict:
    """One scene of the section `precision`."""
    precision = config["precision"]
    shared = {
        name: precision[name]
        for name in ("duration", "sample_interval", "tolerances", "steps", "peers", "max_evaluations")
    }
    return {**shared, "model": {**config["model"], **precision["scenes"][scene]}}


def published_scenes(config: dict) -> dict[str, dict]:
    """The settings of each scene that is published for other solvers."""
    shared = {name: config["published_scenes"][name] for name in ("samples", "tolerance", "compared")}
    precision = config["precision"]
    scenes = {name: {"model": model, "duration": precision["duration"]} for name, model in precision["scenes"].items()}
    return {
        name: {"scene": name, **shared, **scene, "model": {**config["model"], **scene["model"]}}
        for name, scene in {**scenes, **config["published_scenes"]["further"]}.items()
    }


def reference_settings(config: dict) -> dict:
    """The scene of the section `precision` whose reference is computed a second time."""
    precision = config["precision"]
    shared = {name: precision[name] for name in ("duration", "sample_interval")}
    scene, digits = precision["reference"]["scene"], precision["reference"]["digits"]
    return {**shared, "digits": digits, "model": {**config["model"], **precision["scenes"][scene]}}


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


def scaling_case(config: dict, varied: str, axes: dict, *, shards=None, threads=THREADS, conveyors=1) -> dict:
    """A sweep of the chart of scaling, in the planned number of shards unless `shards` is given."""
    own = {"axes": axes, "needs": "vertical", "duration": 0.02, "tolerance": 1.0e-6}
    entry = fill_defaults(config, "sweeps", own)
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


def certificates_settings(config: dict) -> dict:
    return {**config["certificates"], "model": with_normal_model(config, "orbits")["model"]}


def derivatives_settings(config: dict) -> dict:
    return {key: value for key, value in sensitivity_settings(config).items() if key != "curves"}


def curves_settings(config: dict) -> dict:
    settings = sensitivity_settings(config) | {"model": with_normal_model(config, "orbits")["model"]}
    return {key: settings[key] for key in ("longest_period", "curves", "model")}


def of_identification(table: str, config: dict) -> dict:
    model = model_without_acceleration(config)
    return identification_settings(config, table, without_tangential(model) if table == "edges" else model)


FOLLOWED = ("tolerance", "settling")
# The tables that are not entries, and the function that returns the settings of each.
TABLES = {
    **dict.fromkeys(
        ("orbits/branches", "orbits/folds_and_doublings", "orbits/cascade"),
        lambda config: with_normal_model(config, "orbits", solver=("tolerance",)),
    ),
    "orbits/certificates": certificates_settings,
    "orbits/certified_bifurcations": certificates_settings,
    "orbits/certified_chaos": certificates_settings,
    "orbits/certificate_times": certificates_settings,
    "attractors/strobes": lambda config: with_normal_model(config, "attractors", solver=FOLLOWED),
    "lyapunov/spectrum": lambda config: with_normal_model(config, "attractors", "lyapunov", solver=FOLLOWED),
    "lyapunov/witnesses": lambda config: with_normal_model(config, "attractors", "witnesses", solver=FOLLOWED),
    "sensitivity/derivatives": derivatives_settings,
    "sensitivity/groups": derivatives_settings,
    "sensitivity/continued": curves_settings,
    "sensitivity/meetings": curves_settings,
    "operating/shares": operating_settings,
    "operating/regimes": lambda config: None,  # made from other tables only
    "operating/advice": itemgetter("advice"),
    "operating/changes": itemgetter("advice"),
    "operating/throws": partial(of_box, "throws"),
    "operating/track": partial(of_box, "track"),
    "operating/drive_front": drive_settings,
    "operating/drive_generations": drive_settings,
    **{f"identification/{name}": partial(of_identification, name) for name in IDENTIFICATION},
    "results/claims": lambda config: {"claims": config["claims"]},
    "results/benchmark": benchmark_settings,
    "results/reference_check": reference_settings,
    "results/precision_estimates": itemgetter("precision_estimates"),
    "results/stability": itemgetter("stability"),
    "results/stability_estimates": lambda config: with_model(config, "stability_estimates"),
    "results/scene_budget": itemgetter("scene_budget"),
    "results/budget_times": itemgetter("scene_budget"),
    "results/rigid_part": itemgetter("rigid_part"),
    "results/theory": lambda config: with_model(config, "theory"),
    "results/map_check": itemgetter("map_check"),
    "results/settling_times": lambda config: with_normal_model(config, "settling_times", solver=FOLLOWED),
    "results/scaling": lambda config: {**config["scaling"], "sharing": config["sharing"]},
}
# Tables that only an explicit target makes.
ON_REQUEST = ("results/scaling",)


def references(config: dict) -> list[str]:
    """All tables of a config, as SECTION/NAME."""
    entries = [f"{section}/{name}" for section in ENTRIES for name in config[section]]
    scenes = [f"{kind}/{scene}" for kind in ("precision", "precision_times") for scene in config["precision"]["scenes"]]
    return [*entries, *TABLES, *scenes]


def kind_of(reference: str) -> str:
    """The kind of the table SECTION/NAME: its section if it is an entry, else its name."""
    section, name = reference.split("/")
    return name if reference in TABLES else section


def entry_of(config: dict, reference: str) -> dict:
    """The entry of the table SECTION/NAME, {} if the table is not an entry."""
    section, name = reference.split("/")
    return config[section].get(name, {}) if section in ENTRIES else {}


def settings_of(config: dict, reference: str) -> dict | None:
    """The settings of the table SECTION/NAME, or None for a table that is made from other tables only."""
    section, name = reference.split("/")
    if reference in TABLES:
        return TABLES[reference](config)
    if section in ("precision", "precision_times"):
        return precision_settings(config, name)
    return config[section][name] if section == "regressions" else resolve(config, section, name)


def budgeted_tables(config: dict) -> dict[str, list[str]]:
    """The tables of converged trajectories that each figure draws and that the section `scene_budget` covers."""

    def is_budgeted(reference: str) -> bool:
        is_converged = entry_of(config, reference).get("method", "event") == "event"
        is_covered = reference.split("/")[0] in config["scene_budget"]["points"]
        return is_covered and is_converged and reference != "lyapunov/witnesses"

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


def tighter_claims(config: dict) -> dict[str, dict]:
    """The claims whose uncertainty is estimated, with tables of tighter tolerances for the converged solution."""

    def tighten(claim: dict) -> dict:
        tables = claim["tables"]
        tighter = {role: tighter_reference(config, tables[role]) for role in roles_of_solution(tables)}
        return claim | {"tables": tables | tighter}

    return {name: tighten(config["claims"][name]) for name in config["uncertainty"]["claims"]}
