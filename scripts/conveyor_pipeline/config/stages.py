"""The stages of the pipeline, and what their modules scripts/STAGE/settings.py declare."""

from importlib import import_module

# A stage may import the earlier ones.
STAGES = (
    *("sweeps", "motion", "orbits", "dimensions", "fit", "sensitivity", "operating"),
    *("excitation", "calibration", "accuracy", "claims", "figures", "docs"),
)


def declared(mapping: str) -> dict:
    """The entries of a mapping in the settings of all stages, such as SECTIONS; some stages lack it."""
    modules = [import_module(f"scripts.{stage}.settings") for stage in STAGES]
    return {name: entry for module in modules for name, entry in getattr(module, mapping, {}).items()}
