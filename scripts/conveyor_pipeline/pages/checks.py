"""Contradictions in the sections of the pages, as in config/checks.py."""

from collections.abc import Iterator

from conveyor_pipeline.config.checks import faults_of_friction, faults_of_names
from conveyor_pipeline.config.entries import by_methods


def companion(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """Static friction below sliding friction, and sweeps that the config does not have."""
    section = config["companion"]
    sweeps = by_methods(config)["sweeps"]
    yield from faults_of_friction(
        config, {f"companion.presets.{name}": preset for name, preset in section["presets"].items()}
    )
    yield from faults_of_names((f"companion.maps[{place}]", name, sweeps) for place, name in enumerate(section["maps"]))


CHECKS = (companion,)
