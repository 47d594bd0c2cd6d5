"""The tables of a config, and the settings that each table depends on."""

import math

# Sections with one table per entry.
ENTRIES = ("sweeps", "estimates", "critical", "regressions", "dimensions", "signals", "spectra", "impacts")
# Sections with fixed tables.
TABLES = {
    "orbits": (
        "branches",
        "folds_and_doublings",
        "cascade",
        "certificates",
        "certified_bifurcations",
        "certified_chaos",
        "certificate_times",
    ),
    "attractors": ("strobes",),
    "lyapunov": ("spectrum", "witnesses"),
    "sensitivity": ("derivatives", "groups", "continued", "meetings"),
    "operating": ("shares", "regimes"),
    "identification": ("edges", "printed", "front", "generations", "profiles", "optima", "frictions", "implied"),
    "results": (
        "claims",
        "benchmark",
        "precision_estimates",
        "stability",
        "stability_estimates",
        "scene_budget",
        "budget_times",
        "rigid_part",
        "settling_times",
        "scaling",
    ),
}
# Tables that only an explicit target makes.
ON_REQUEST = ("scaling",)
# Tables of `results` whose settings stand in a section with another name.
SECTION_OF = {"budget_times": "scene_budget"}
# Sections that follow initial conditions until the motion settles.
SETTLING = ("sweeps", "critical", "impacts", "signals", "spectra")
# Sections whose entries may list several methods.
METHOD_SECTIONS = ("sweeps", "estimates", "critical", "signals", "spectra")

# Sections whose tables depend on a tolerance, directly or through another table.
TIGHTENED = ("sweeps", "estimates", "critical", "dimensions", "signals", "spectra", "regressions")
TIGHTER = "tighter"


def entry_of(config: dict, reference: str) -> dict | None:
    """The settings of the table SECTION/NAME, or None if there is no such table."""
    section, name = reference.split("/")
    if name in TABLES.get(section, ()):
        return config[SECTION_OF.get(name, name) if section == "results" else section]
    if section in ("precision", "precision_times"):
        return config["precision"] if name in config["precision"]["scenes"] else None
    return config[section].get(name) if section in ENTRIES else None


def kind_of(reference: str) -> str:
    """The kind of the table SECTION/NAME: its name in sections with fixed tables, else its section."""
    section, name = reference.split("/")
    return name if section in TABLES else section


def by_methods(config: dict) -> dict:
    """A config with one method per entry: NAME has the first of its `methods`, NAME_METHOD each further one."""
    found = dict(config)
    for section in METHOD_SECTIONS:
        found[section] = {}
        for name, entry in config[section].items():
            if "methods" not in entry:
                found[section][name] = entry
                continue
            alone = {key: value for key, value in entry.items() if key != "methods"}
            first, *others = entry["methods"]
            found[section][name] = alone | {"method": first}
            found[section] |= {f"{name}_{method}": alone | {"method": method} for method in others}
    return found


def roles_of_solution(tables: dict[str, str]) -> list[str]:
    """The roles of the converged solution among the tables of a claim; all roles if none is named converged."""
    named = [role for role in tables if role.startswith("converged")]
    return named or list(tables)


def tighter_reference(config: dict, reference: str) -> str:
    """The twin of a table with a tighter tolerance, or the table itself if it has no such twin."""
    section, name = reference.split("/")
    twin = f"{name}_{TIGHTER}"
    return f"{section}/{twin}" if section in ENTRIES and twin in config[section] else reference


def with_tighter(config: dict) -> dict:
    """A config with twins NAME_tighter of the tables behind the claims in `uncertainty`, with a tighter tolerance."""
    found = config | {section: dict(config[section]) for section in TIGHTENED}

    def tighten(reference: str) -> None:
        section, name = reference.split("/")
        entry = config[section][name] if section in TIGHTENED else {"method": None}
        if section == "regressions":
            tighten(f"critical/{entry['critical']}")
            found[section][f"{name}_{TIGHTER}"] = entry | {"critical": f"{entry['critical']}_{TIGHTER}"}
        elif entry.get("method", config["solver"]["method"]) == "event":
            tolerance = entry.get("tolerance", config["solver"]["tolerance"]) / config["uncertainty"]["tighter"]
            found[section][f"{name}_{TIGHTER}"] = entry | {"tolerance": tolerance}

    for name in config["uncertainty"]["claims"]:
        tables = config["claims"][name]["tables"]
        for role in roles_of_solution(tables):
            tighten(tables[role])
    return found


def references(config: dict) -> list[str]:
    """All tables of a config, as SECTION/NAME."""
    names = {section: config[section] for section in ENTRIES} | TABLES
    names |= dict.fromkeys(("precision", "precision_times"), config["precision"]["scenes"])
    return [f"{section}/{name}" for section, of_section in names.items() for name in of_section]


def resolve(config: dict, section: str, name: str) -> dict:
    """All settings that the table `section`/`name` depends on, with the defaults filled in."""
    entry = {
        **{key: config["solver"][key] for key in ("duration", "method", "tolerance", "step")},
        **config[section][name],
    }
    if section in SETTLING:
        entry["settling"] = config["solver"]["settling"]
    entry["model"] = {**config["model"], **entry.get("model", {})}
    for axis in entry.get("axes", ()):
        del entry["model"][axis]
    del entry["step" if entry["method"] == "event" else "tolerance"]
    return entry


def ends(axis: list | dict) -> list:
    """The values of an axis, or the first and the last one."""
    return axis if isinstance(axis, list) else [axis["start"], axis["stop"]]


def values_of(entry: dict, name: str) -> list:
    """The values that a parameter takes in a resolved entry, or the ends of their range."""
    return ends(entry["axes"][name]) if name in entry["axes"] else [entry["model"][name]]


def count_values(axis: list | dict) -> int:
    """Number of values of an axis."""
    return len(axis) if isinstance(axis, list) else int(axis["num"])


def count_points(axes: dict) -> int:
    """Number of points in the product of axes."""
    return math.prod(map(count_values, axes.values()))
