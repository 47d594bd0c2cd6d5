"""The tables whose accuracy the scene budget compares. Imported by the Snakefile: no slow imports."""

import itertools

from conveyor_pipeline.config.tables import entry_of, settings_of
from conveyor_pipeline.study.accuracy.settings import BUDGETED


def budgeted_tables(config: dict) -> dict[str, list[str]]:
    """The tables of converged trajectories that each figure draws and that the section `scene_budget` covers."""

    def is_budgeted(reference: str) -> bool:
        is_converged = entry_of(config, reference).get("method", "event") == "event"
        is_covered = reference.split("/")[0] in BUDGETED
        return is_covered and is_converged

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
