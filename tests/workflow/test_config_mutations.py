"""Mutations of the paper's config: an error of one value names its key, and no other key."""

import copy
import math

import pytest
from project import merged, permuted, read_config

from conveyor_pipeline.config import canonical, problems
from conveyor_pipeline.config.files import walk

CONFIG = read_config()
# Values that are invalid wherever another value of the same type is valid.
WRONG = {
    float: ["abc", "5e5 furlong", math.nan, math.inf, -math.inf, [], {}, True, 10**400],
    int: ["abc", "5e5 m", math.nan, math.inf, 2.5, [], {}, True, -(10**30), 10**400],
    str: [5, None, [], {}, True, math.nan],
    list: [None, "abc", {}, 3, [None], [[1, 2], [3]], {"a": 1}],
    dict: [None, "abc", [], 3, True],
}


def is_of_names(path: tuple) -> bool:
    """Whether a mapping may have any name as a key."""
    places = {("figures",), ("companion", "presets")}
    entries = {"sweeps", "estimates", "critical", "regressions", "dimensions", "signals", "spectra", "impacts"}
    return path in places or (len(path) == 1 and path[0] in entries)


def declaration(path: tuple, value) -> tuple:
    """What the places with one declaration have in common: all but names of entries and numbers of list items."""
    names = ("*" if isinstance(part, int) or is_of_names(path[:k]) else part for k, part in enumerate(path))
    return *names, type(value)


# One place of each declaration, because all places that share it are checked by the same code.
PLACES = list({declaration(path, value): (path, value) for path, value in walk(CONFIG)}.values())
SECTIONS = list(CONFIG)


def key_of(path: tuple) -> str:
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in path).lstrip(".")


def changed(path: tuple, change) -> dict:
    """A copy of the config after `change` was called with the mapping or list above `path`, and its last part."""
    config = here = dict(CONFIG)
    for part in path[:-1]:
        here[part] = copy.copy(here[part])
        here = here[part]
    change(here, path[-1])
    return config


def put(path: tuple, value) -> dict:
    def change(here, part):
        here[part] = value

    return changed(path, change)


def assert_reported(config: dict, path: tuple, name: str = "") -> None:
    """Assert that a line names the key of `path`, and `name`, and that all lines have a readable length."""
    lines = problems(config)
    assert any(key_of(path) in line and name in line for line in lines), (key_of(path), lines)
    assert all(len(line) < 600 and line.isprintable() for line in lines), lines


def places(section: str, *kinds: type) -> list[tuple[tuple, object]]:
    return [(path, value) for path, value in PLACES if path[0] == section and type(value) in kinds]


def may_be(path: tuple, value) -> bool:
    """Whether a value of another type is valid at a path: numbers that happen to be whole in the config."""
    return (path[-1] == "z0" and value == 5) or (path[-1] == "longest" and value == 2.5)


@pytest.mark.parametrize("section", SECTIONS)
def test_a_value_of_another_type_is_reported(section):
    for path, value in [((section,), CONFIG[section]), *places(section, *WRONG)]:
        for wrong in WRONG[type(value)]:
            if not may_be(path, wrong):
                assert_reported(put(path, wrong), path)


@pytest.mark.parametrize("section", SECTIONS)
def test_null_is_reported(section):
    for path, _ in places(section, float, int):
        assert_reported(put(path, None), path)


@pytest.mark.parametrize("section", SECTIONS)
def test_a_misspelt_key_and_a_key_that_is_not_text_are_reported(section):
    for path, value in [((section,), CONFIG[section]), *places(section, dict)]:
        if not isinstance(value, dict):
            continue
        for name in value:
            misspelt = {key + "x" if key == name else key: item for key, item in value.items()}
            # Another name of an entry is valid; references to the old name, if any, are not.
            if not is_of_names(path):
                assert_reported(put(path, misspelt), path, f"{name}x")
        for key in (1, True, None):
            assert_reported(put(path, {**value, key: 1}), path, repr(key))
        assert_reported(put(path, {**value, "extra key": 1}), path, "extra key")


@pytest.mark.parametrize("section", SECTIONS)
def test_reversed_bounds_are_reported(section):
    for path, value in places(section, dict):
        if value.keys() >= {"start", "stop"}:
            backwards = {**value, "start": value["stop"], "stop": value["start"]}
            assert_reported(put(path, backwards), path)
    for path, value in places(section, list):
        if path[-1] in ("limits", "A", "B", "C", "two_states", "scan"):
            assert_reported(put(path, value[::-1]), path) if value[0] != value[1] else None


@pytest.mark.parametrize(
    "path", [(section,) for section in SECTIONS] + [("model", key) for key in CONFIG["model"]], ids=key_of
)
def test_a_missing_key_is_reported(path):
    def delete(here, part):
        del here[part]

    assert_reported(changed(path, delete), path, "is missing")


def test_another_order_or_spelling_is_valid_and_equivalent():
    other = permuted(CONFIG)
    assert problems(other) == []
    assert repr(canonical(merged(CONFIG, other))) == repr(canonical(CONFIG))


@pytest.mark.parametrize("config", [None, [], "model", 3], ids=repr)
def test_a_section_that_is_not_a_mapping_is_reported(config):
    assert problems(config) == [f"config = {config!r} should be a valid mapping"]


def test_a_list_in_place_of_keys_is_reported():
    assert problems(merged(CONFIG, {"model": [1, 2]})) == ["model = [1, 2] should have keys below it"]
