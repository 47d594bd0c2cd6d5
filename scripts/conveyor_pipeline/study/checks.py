"""Contradictions in the sections of the floor study, as in config/checks.py."""

from collections.abc import Iterator

from conveyor_pipeline.config.checks import faults_of_names, known_tables
from conveyor_pipeline.config.entries import by_methods

# s, a multiple of all time steps of the comparison of methods (STEPS in accuracy/precision.py)
LONGEST_STEP = 1e-3


def precision(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    duration = config["precision"]["duration"]
    if abs(duration / LONGEST_STEP - round(duration / LONGEST_STEP)) > 1e-9:
        yield f"precision.duration = {duration!r} s is not a multiple of the longest time step, {LONGEST_STEP} s"


def unknown_names(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """Names of tables and sweeps that the config does not have."""
    tables = known_tables(config, defaults)
    sweeps = by_methods(config)["sweeps"]
    used = [(f"scene_budget.reasons.{table}", table, tables) for table in config["scene_budget"]["reasons"]]
    used += [(f"map_check.maps[{place}]", name, sweeps) for place, name in enumerate(config["map_check"]["maps"])]
    yield from faults_of_names(used)


CHECKS = (precision, unknown_names)
