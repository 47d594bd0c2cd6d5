"""The floors of the pipeline, their stages, and what the modules settings.py of the stages declare."""

from importlib import import_module

# To remove the floor machine or study, delete its line here and the folders of its name (see CONTRIBUTING.md).
FLOORS = {
    "paper": ("sweeps", "motion", "orbits", "dimensions", "fit", "sensitivity", "claims"),
    "machine": ("operating", "contact", "excitation", "calibration"),
    "study": ("accuracy",),
}
# The packages of all stages. A stage may import the earlier ones of its floor and of the floor paper.
STAGES = {stage: f"conveyor_pipeline.{floor}.{stage}" for floor, stages in FLOORS.items() for stage in stages}
# Packages that all floors share, and the pages.
SHARED = ("conveyor_pipeline.figures", "conveyor_pipeline.pages")


def declared(name: str) -> dict:
    """The entries of a mapping in the settings of all stages, such as SECTIONS; some stages lack it."""
    modules = [import_module(f"{package}.settings") for package in (*STAGES.values(), *SHARED)]
    return {key: entry for module in modules for key, entry in getattr(module, name, {}).items()}
