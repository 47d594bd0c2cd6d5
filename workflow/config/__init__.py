"""The config: read, checked, scaled to the conveyor, and converted to the one form that rules and hashes depend on."""

import itertools
import os
import sys
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

from .checks import problems
from .entries import MEASURED_FILES, by_methods, with_tighter
from .errors import ConfigError, type_problems
from .files import changed_values, merge, name_lines, read_all
from .model import MODEL
from .own_conveyor import describe_scaling, is_own_conveyor, names_conveyor, scale_config

__all__ = ["ConfigError", "Loaded", "announce", "canonical", "load_config", "problems"]


class Loaded(NamedTuple):
    """A config with everything that the rules need to know about it."""

    config: dict  # canonical, with the tables of all methods and of tighter tolerances
    paper: dict  # the default config
    own_conveyor: bool
    notice: str  # what was scaled to another conveyor and what was dropped; empty for the paper's


def canonical(config: dict) -> dict:
    """A valid config in its one form: keys in the order of the model, numbers in the types of the model.

    The entries of a section and the axes of an entry keep their order, which has a meaning.
    """
    return MODEL.validate_python(config)


def name_measurements(config: dict, files: Sequence[str | Path], contents: list[dict]) -> None:
    """Replace the names of files of measurements, relative to the overlay that names them, by their paths.

    A name that no overlay gives, such as one from the command line, is relative to the working directory.
    """
    for section, key in MEASURED_FILES:
        given = config[section].get(key)
        for file, content in zip(files, contents, strict=True):
            own = content.get(section)
            if isinstance(own, dict) and isinstance(given, str) and own.get(key) == given:
                config[section][key] = os.path.join(os.path.dirname(file), own[key])


def describes_conveyor(paper: dict, overlay: dict) -> bool:
    """Whether an overlay is for a conveyor other than the paper's: by its parameters, or by measurements of it."""
    return names_conveyor(paper, overlay) or any(key in overlay.get(section, {}) for section, key in MEASURED_FILES)


def load_config(default_files: Sequence[str | Path], overlay_files: Sequence[str | Path], config: dict) -> Loaded:
    """The config of a run; ConfigError says what is wrong with it in at most six lines.

    Parameters
    ----------
    default_files : the config of the paper
    overlay_files : files that are merged over it. `config` contains them already; they are read again because keys keep
        the order of the first file that has them, and because files in front of the conveyor's are scaled to it
    config : Snakemake's merged config. As a module of another workflow, it is the only overlay
    """
    paper, overlays = merge(*read_all(default_files)), read_all(overlay_files)
    whole = merge(paper, *overlays, config)
    # Not whether values fit together: an overlay may give one end of a range whose other end is scaled below.
    if errors := type_problems(whole, ignored="value_error"):
        raise ConfigError(name_lines(errors, overlay_files))
    if own_conveyor := is_own_conveyor(paper, whole):
        # The overlays in front of the conveyor's, such as config/reduced.yaml, are for the paper's conveyor.
        before = list(itertools.takewhile(lambda overlay: not describes_conveyor(paper, overlay), overlays))
        own = merge(*overlays[len(before) :], changed_values(merge(*overlays), config))
        base = merge(paper, *before)
        if errors := type_problems(base):
            raise ConfigError(errors)
        whole = merge(scale_config(base, own), own)
        # The claims are the paper's. An overlay for any conveyor, such as config/reduced.yaml, may name them.
        checked = whole["uncertainty"]["claims"]
        whole["uncertainty"] |= {"claims": [name for name in checked if name in whole["claims"]]}
    name_measurements(whole, overlay_files, overlays)
    if errors := problems(whole, paper):
        raise ConfigError(name_lines(errors, overlay_files))
    for section, key in MEASURED_FILES:
        if key not in whole[section]:
            whole["figures_on_request"].pop(section, None)
    loaded = with_tighter(by_methods(canonical(whole)))
    return Loaded(loaded, paper, own_conveyor, describe_scaling(paper, loaded) if own_conveyor else "")


@cache
def announce(notice: str) -> None:
    """Print a notice once, although Snakemake reads the Snakefile of a module for each `use rule`."""
    print(notice, file=sys.stderr)
