"""The tables of a config, and the settings of each table: the part of the config that its script needs.

The rule that makes a table passes its settings to the script, which stores them in the table. A rule that reads the
table expects the same settings, so a table that was made from other settings is refused. Snakemake would notice other
settings only as long as it has its own records, which neither an archive nor a copy of the results contains.
"""

import itertools

from scripts.accuracy.scenes import SCENES
from scripts.accuracy.settings import precision_settings

from .entries import ENTRIES, TIGHTER, resolve
from .stages import declared

# The tables that are not entries, and the function that returns the settings of each.
TABLES = declared("TABLE_SETTINGS")


def references(config: dict) -> list[str]:
    """All tables of a config, as SECTION/NAME."""
    entries = [f"{section}/{name}" for section in ENTRIES for name in config[section]]
    scenes = [f"{kind}/{scene}" for kind in ("precision", "precision_times") for scene in SCENES]
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
        raise ValueError(f"{reference} is no table; add it to TABLE_SETTINGS in the settings of its stage")
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
