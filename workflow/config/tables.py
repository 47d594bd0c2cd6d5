"""The tables of a config, and the settings of each table: the part of the config that its script needs.

The rule that makes a table passes its settings to the script, which stores them in the table. A rule that reads the
table expects the same settings, so a table that was made from other settings is refused.
"""

import itertools
from functools import partial
from operator import itemgetter

from scripts.identification.settings import POSTERIOR, identification_settings

from .entries import ENTRIES, TIGHTER, resolve, without_tangential


def model_of(config: dict, section: str = "", *, normal: bool = False) -> dict:
    """The model with the overrides of a section, for tables that state their amplitudes.

    It has no amplitude, so that another default amplitude does not rerun these tables. With `normal`, it has only what
    affects the motion normal to the track.
    """
    model = {name: value for name, value in config["model"].items() if name != "acceleration"}
    if section:
        model |= config[section].get("model", {})
    return without_tangential(model) if normal else model


def with_model(config: dict, *sections: str, solver: tuple[str, ...] = (), normal: bool = False) -> dict:
    """Settings of the solver and of sections of the config, of which later ones win, with the first one's model."""
    settings = {key: config["solver"][key] for key in solver}
    for section in sections:
        settings |= config[section]
    return {**settings, "model": model_of(config, sections[0], normal=normal)}


def box_settings(section: str, config: dict) -> dict:
    """A section whose initial conditions are drawn from the box of the section `operating`."""
    box = {key: value for key, value in config["operating"].items() if key not in ("acceleration", "resolution")}
    limits = {key: config["solver"][key] for key in ("settling", "mean_settling")}
    own = {**box, **config[section], **limits}
    stated = ("psi0", "z0", "vz0", *config[section], *own.get("bounds", ()))
    return {**own, "model": {name: value for name, value in model_of(config).items() if name not in stated}}


def transit_settings(config: dict) -> dict:
    """The box of `operating`, the section `transit`, and how its parts differ."""
    box = {name: config["operating"][name] for name in ("height", "vz0", "psi0", "seed", "tolerance")}
    transit = {name: value for name, value in config["transit"].items() if name != "parts"}
    model = {name: value for name, value in model_of(config).items() if name not in ("psi0", "z0", "vz0")}
    return {**box, **transit, "starts": config["transit"]["parts"], "spread": config["parts"], "model": model}


def drift_settings(config: dict) -> dict:
    """The parts of the transit table without their differences."""
    transit = {name: value for name, value in transit_settings(config).items() if name != "spread"}
    return {**transit, **config["drift"]}


def drive_settings(config: dict) -> dict:
    """The search follows the parts of the transit table, within the error of the amplitude that the advice states."""
    transit = {name: value for name, value in transit_settings(config).items() if name != "acceleration"}
    drive = config["drive"]
    model = {name: value for name, value in transit["model"].items() if name not in drive["bounds"]}
    return {**transit, **drive, "margin": config["advice"]["margin"], "model": model}


def calibration_settings(config: dict) -> dict:
    """The search leaves the values of the searched parameters in the model open. The static friction stays as stated
    and limits the friction; 0 stands for none. A config to which calibrated parameters are added has the same settings.
    """
    own, model = config["calibration"], model_of(config)
    static_friction = model.get("static_friction", 0.0)
    ranges = {name: own["ranges"][name] for name in own["parameters"]}
    if static_friction and "friction" in ranges:
        ranges["friction"] = [ranges["friction"][0], min(ranges["friction"][1], static_friction)]
    stated = ("psi0", "z0", "vz0", "static_friction", *own["parameters"])
    return {
        **{name: config["operating"][name] for name in ("height", "vz0", "psi0")},
        **own,
        "ranges": ranges,
        "static_friction": static_friction,
        "model": {name: value for name, value in model.items() if name not in stated},
    }


def calibration_study_settings(config: dict) -> dict:
    """The study calibrates with the settings of the config, without its conveyor and its measurements."""
    own = {name: value for name, value in calibration_settings(config).items() if name not in ("measurements", "model")}
    own["ranges"] = {name: config["calibration"]["ranges"][name] for name in ("friction", "damping", "stiffness")}
    own["parameters"] = list(own["ranges"])
    box = {name: config["operating"][name] for name in ("height", "vz0", "psi0")}
    model = {
        name: value for name, value in model_of(config).items() if name not in ("z0", "static_friction", "psi0", "vz0")
    }
    return {**box, "calibration": own, "model": model}


def precision_settings(config: dict, scene: str) -> dict:
    """One scene of the section `precision`."""
    precision = config["precision"]
    shared = {name: precision[name] for name in ("duration", "max_evaluations")}
    return {**shared, "model": {**config["model"], **precision["scenes"][scene]}}


def published_scenes(config: dict) -> dict[str, dict]:
    """The settings of each scene that is published for other solvers."""
    precision = config["precision"]
    scenes = {name: {"model": model, "duration": precision["duration"]} for name, model in precision["scenes"].items()}
    return {
        name: {"scene": name, **scene, "model": {**config["model"], **scene["model"]}}
        for name, scene in {**scenes, **config["published_scenes"]["further"]}.items()
    }


def reference_settings(config: dict) -> dict:
    """The scene whose reference is computed a second time: the jumping part."""
    precision = config["precision"]
    return {"duration": precision["duration"], "model": {**config["model"], **precision["scenes"]["jumping"]}}


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


def certificates_settings(config: dict) -> dict:
    return {**config["certificates"], "model": model_of(config, "orbits", normal=True)}


def derivatives_settings(config: dict) -> dict:
    own = {key: value for key, value in config["sensitivity"].items() if key != "curves"}
    return {**own, "model": model_of(config, "orbits")}


def curves_settings(config: dict) -> dict:
    own = {key: config["sensitivity"][key] for key in ("longest_period", "most", "curves")}
    return {**own, "model": model_of(config, "orbits", normal=True)}


def identification_table_settings(table: str, config: dict) -> dict:
    return identification_settings(config, table, model_of(config, normal=table == "edges"))


def comparison_settings(config: dict) -> dict:
    """The parts of the transit table, on the measured drive."""
    transit = {name: value for name, value in transit_settings(config).items() if name != "acceleration"}
    measured = ("frequency", "angle", "phase_shift", "harmonics")
    model = {name: value for name, value in transit["model"].items() if name not in measured}
    return {**transit, "model": model, "matters": config["clean_drive"]["matters"]}


def clean_drive_settings(config: dict) -> dict:
    """The parts of the transit table, on drives with one harmonic."""
    transit = {name: value for name, value in transit_settings(config).items() if name != "acceleration"}
    return {**transit, **config["clean_drive"]}


FOLLOWED = ("tolerance", "settling", "mean_settling")
EXCITATION_TABLES = ("parameters", "harmonics", "quality", "samples", "waveform", "spectrum")
CALIBRATION_TABLES = ("parameters", "samples", "fit", "alternatives", "prediction", "next")
# The tables that are not entries, and the function that returns the settings of each.
TABLES = {
    **dict.fromkeys(
        ("orbits/branches", "orbits/folds_and_doublings", "orbits/cascade"),
        lambda config: with_model(config, "orbits", solver=("tolerance",), normal=True),
    ),
    "orbits/certificates": certificates_settings,
    "orbits/certified_bifurcations": certificates_settings,
    "orbits/certified_chaos": certificates_settings,
    "orbits/certificate_times": certificates_settings,
    "attractors/strobes": lambda config: with_model(config, "attractors", solver=FOLLOWED, normal=True),
    "lyapunov/spectrum": lambda config: with_model(config, "attractors", "lyapunov", solver=FOLLOWED, normal=True),
    "lyapunov/witnesses": lambda config: with_model(config, "attractors", solver=FOLLOWED, normal=True),
    "sensitivity/derivatives": derivatives_settings,
    "sensitivity/groups": derivatives_settings,
    "sensitivity/continued": curves_settings,
    "sensitivity/meetings": curves_settings,
    "operating/shares": partial(box_settings, "operating"),
    "operating/regimes": partial(box_settings, "operating"),
    "operating/transit": transit_settings,
    "operating/drift": drift_settings,
    "operating/track_lengths": drift_settings,
    "operating/advice": itemgetter("advice"),
    "operating/changes": itemgetter("advice"),
    "operating/throws": partial(box_settings, "throws"),
    "operating/track": partial(box_settings, "track"),
    "operating/drive_front": drive_settings,
    "operating/drive_generations": drive_settings,
    **{f"identification/{name}": partial(identification_table_settings, name) for name in ("edges", *POSTERIOR)},
    **dict.fromkeys((f"excitation/{name}" for name in EXCITATION_TABLES), itemgetter("excitation")),
    "excitation/comparison": comparison_settings,
    "excitation/clean_drive": clean_drive_settings,
    **dict.fromkeys((f"calibration/{name}" for name in CALIBRATION_TABLES), calibration_settings),
    "results/claims": lambda config: {"claims": config["claims"]},
    "results/benchmark": benchmark_settings,
    "results/reference_check": reference_settings,
    "results/stability": itemgetter("stability"),
    "results/stability_estimates": lambda config: {"model": model_of(config)},
    "results/scene_budget": itemgetter("scene_budget"),
    "results/budget_times": itemgetter("scene_budget"),
    "results/rigid_part": lambda config: {},
    "results/theory": lambda config: {"model": model_of(config)},
    "results/map_check": itemgetter("map_check"),
    "results/settling_times": lambda config: with_model(config, "settling_times", solver=FOLLOWED, normal=True),
    "results/calibration_study": calibration_study_settings,
}
# Tables that only an explicit target makes.
ON_REQUEST = (
    "results/calibration_study",
    *(f"excitation/{name}" for name in (*EXCITATION_TABLES, "comparison")),
    *(f"calibration/{name}" for name in CALIBRATION_TABLES),
)


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


def settings_of(config: dict, reference: str) -> dict:
    """The settings of the table SECTION/NAME."""
    section, name = reference.split("/")
    if reference in TABLES:
        return TABLES[reference](config)
    if section in ("precision", "precision_times"):
        return precision_settings(config, name)
    if section not in ENTRIES:
        raise ValueError(f"{reference} is no table; add it to TABLES in workflow/config/tables.py")
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
    known, found = set(references(config)), {}
    for name in config["uncertainty"]["claims"]:
        claim = config["claims"][name]
        # A claim without a role of this name reads converged tables only.
        roles = [role for role in claim["tables"] if role.startswith("converged")] or claim["tables"]
        tighter = {role: claim["tables"][role] + TIGHTER for role in roles if claim["tables"][role] + TIGHTER in known}
        found[name] = claim | {"tables": claim["tables"] | tighter}
    return found
