"""The config: read, checked, and converted to the one form that rules and hashes depend on."""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from conveyor_pipeline.config.checks import default_config, other_models, problems
from conveyor_pipeline.config.derived import with_derived
from conveyor_pipeline.config.entries import MEASURED_FILES, by_methods, with_tighter
from conveyor_pipeline.config.errors import ConfigError, type_problems
from conveyor_pipeline.config.files import merge, name_lines, read
from conveyor_pipeline.config.model import MODEL
from conveyor_pipeline.config.scales import to_si

__all__ = ["ConfigError", "Loaded", "canonical", "load_config", "problems"]


class Loaded(NamedTuple):
    """A config with everything that the rules need to know about it."""

    config: dict  # canonical, with the tables of all methods and of tighter tolerances
    merged: dict  # canonical, as files and command line give it
    is_paper: bool  # whether all models are the paper's and nothing is measured, so that its claims and marks apply
    stated: dict  # what overlays and command line state, as they give it


def canonical(config: dict) -> dict:
    """A valid config in its one form: SI units, derived values, keys in the order and numbers in the types of MODEL.

    The entries of a section and the axes of an entry keep their order, which has a meaning.
    """
    return MODEL.validate_python(with_derived(to_si(MODEL.validate_python(config))))


def name_measurements(config: dict, files: Sequence[str | Path], contents: list[dict]) -> None:
    """Replace the names of files of measurements, relative to the overlay that names them, by their paths.

    A name that no overlay gives, such as one from the command line, is relative to the working directory.
    """
    for section, key in MEASURED_FILES.items():
        name = config[section].get(key)
        for file, content in zip(files, contents, strict=True):
            if name and (content.get(section) or {}).get(key) == name:
                config[section][key] = os.path.join(os.path.dirname(file), name)


def check_one_conveyor(files: Sequence[str | Path], contents: list[dict]) -> None:
    """ConfigError for overlays of two conveyors, which would become one mixed conveyor."""
    overlays = zip(files, contents, strict=True)
    named = {content["prefix"]: file for file, content in overlays if content.get("prefix") and content.get("model")}
    if len(named) > 1:
        conveyors = " and ".join(f"{name} ({file})" for name, file in named.items())
        raise ConfigError(
            [
                f"prefix and model are given for {conveyors}, which would be mixed",
                "run one command for each conveyor, each in a file of its own, not in config/config.yaml; if one of "
                "them changes the other, leave out the prefix of the other",
            ]
        )


def load_config(overlay_files: Sequence[str | Path], config: dict) -> Loaded:
    """The config of a run; ConfigError says what is wrong with it in at most six lines.

    Parameters
    ----------
    overlay_files : files over the default config. `config` contains them already; they are read again because keys keep
        the order of the first file that has them, and because names of measurements are relative to them
    config : Snakemake's merged config. As a module of another workflow, it is the only overlay
    """
    paper, overlays = default_config(), [read(file) for file in overlay_files]
    whole = merge(paper, *overlays, config)
    if errors := type_problems(whole):
        raise ConfigError(name_lines(errors, overlay_files, config))
    check_one_conveyor(overlay_files, overlays)
    name_measurements(whole, overlay_files, overlays)
    stated = merge(*overlays, config)
    if errors := problems(whole, paper, stated):
        raise ConfigError(name_lines(errors, overlay_files, config))
    measured = [section for section, key in MEASURED_FILES.items() if key in whole[section]]
    for section in MEASURED_FILES.keys() - measured:
        whole["figures_on_request"].pop(section, None)
    merged = canonical(whole)
    is_paper = not measured and not any(other_models(merged, paper))
    return Loaded(with_tighter(by_methods(merged)), merged, is_paper, stated)
