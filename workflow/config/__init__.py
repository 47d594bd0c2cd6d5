"""Interim face."""

from pathlib import Path
from typing import NamedTuple
from workflow.config_files import as_first_written, merged, read, refusal
from workflow.configuration import by_methods, canonical, problems, with_tighter
from workflow.own_machine import fitted, is_own, model_problems, refusals

ROOT = Path(__file__).resolve().parents[2]


class ConfigError(Exception):
    pass


class Loaded(NamedTuple):
    config: dict
    paper: dict
    own_machine: bool
    refused: dict


def load_config(default_files, overlay_files, config, check=True):
    read_files = [read(file) for file in [*default_files, *overlay_files]]
    if errors := [fault for faults, _ in read_files for fault in faults]:
        raise ConfigError(refusal(errors))
    contents = [content for _, content in read_files]
    n = len(default_files)
    paper = merged(*contents[:n])
    own = is_own(paper, config)
    if own:
        if errors := model_problems(paper, config):
            raise ConfigError(refusal(errors))
        contents = [fitted(paper, config), *contents[n:]]
    whole = as_first_written(merged(*contents, config), contents)
    if check and (errors := problems(whole)):
        raise ConfigError(refusal(errors))
    final = with_tighter(by_methods(canonical(whole)))
    return Loaded(final, paper, own, refusals(paper, final))
