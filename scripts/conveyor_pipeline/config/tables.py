"""The tables of a config, and the settings of each table: the part of the config that its script needs.

The rule that makes a table passes its settings to the script, which stores them in the table. A rule that reads the
table expects the same settings, so a table that was made from other settings is refused. Snakemake would notice other
settings only as long as it has its own records, which a copy of the results does not contain.
"""

from conveyor_pipeline.common.table_settings import model_of
from conveyor_pipeline.config.entries import ENTRIES, TIGHTER, resolve
from conveyor_pipeline.config.stages import declared

# Tables that are not entries, and the function that returns the settings of each. A table that is missing here depends
# on the model and, if there is one, on the section of its name.
TABLES = declared("TABLE_SETTINGS")
# Kinds with a table for each of several names, and the function that returns the settings for a name.
FAMILIES = declared("TABLE_FAMILIES")
NAMED = (*ENTRIES, *FAMILIES)


def references(config: dict) -> list[str]:
    """All tables of a config that are entries, in TABLES or in FAMILIES, as SECTION/NAME."""
    entries = [f"{section}/{name}" for section in ENTRIES for name in config[section]]
    families = [f"{kind}/{name}" for kind, (names, _) in FAMILIES.items() for name in names]
    return [*entries, *TABLES, *families]


def references_of(entries: dict) -> list[str]:
    """The tables that claims read, or figures with their captions; `entries` are the claims or figures by name."""
    roles = [entry.get(key, {}) for entry in entries.values() for key in ("tables", "caption_tables")]
    return sorted({reference for of_entry in roles for reference in of_entry.values()})


def kind_of(reference: str) -> str:
    """The kind of the table SECTION/NAME: its section if it is an entry or in a family, else its name."""
    section, name = reference.split("/")
    return section if section in NAMED else name


def entry_of(config: dict, reference: str) -> dict:
    """The entry of the table SECTION/NAME, {} if the table is not an entry."""
    section, name = reference.split("/")
    return config[section].get(name, {}) if section in ENTRIES else {}


def settings_of(config: dict, reference: str) -> dict:
    """The settings of the table SECTION/NAME."""
    section, name = reference.split("/")
    if reference in TABLES:
        return TABLES[reference](config)
    if section in FAMILIES:
        return FAMILIES[section][1](config, name)
    if section not in ENTRIES:
        return {**config.get(name, {}), "model": model_of(config)}
    return config[section][name] if section == "regressions" else resolve(config, section, name)


def tighter_claims(config: dict, claims: dict[str, dict]) -> dict[str, dict]:
    """The claims whose uncertainty is estimated, with tables of tighter tolerances for the converged solution."""
    known = set(references(config))
    tightened = {}
    for name in config["uncertainty"]["claims"]:
        claim = claims[name]
        # A claim without a role of this name reads converged tables only.
        roles = [role for role in claim["tables"] if role.startswith("converged")] or claim["tables"]
        tighter = {role: claim["tables"][role] + TIGHTER for role in roles if claim["tables"][role] + TIGHTER in known}
        tightened[name] = claim | {"tables": claim["tables"] | tighter}
    return tightened
