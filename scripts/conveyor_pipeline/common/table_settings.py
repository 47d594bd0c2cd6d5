"""Settings of tables: the parts of a config that several of them depend on.

Each stage has a mapping TABLE_SETTINGS in its module of settings: the names of its tables that are not entries of the
config, as SECTION/NAME, with the functions that return their settings. Imported by the Snakefile: no slow imports.
"""

from collections.abc import Iterable

from conveyor.parameters import TANGENTIAL


def without_tangential(model: dict) -> dict:
    """A model without the parameters that do not affect the motion normal to the track."""
    return {name: value for name, value in model.items() if name not in TANGENTIAL}


def model_of(config: dict, section: str = "", *, normal: bool = False, without: Iterable[str] = ()) -> dict:
    """The model with the overrides of a section, for tables that state their amplitudes.

    It has no amplitude, so that another default amplitude does not rerun these tables, and none of the parameters
    `without`. With `normal`, it has only what affects the motion normal to the track.
    """
    model = {name: value for name, value in config["model"].items() if name != "acceleration"}
    if section:
        model |= config[section].get("model", {})
    model = {name: value for name, value in model.items() if name not in set(without)}
    return without_tangential(model) if normal else model
