"""config/schema.json: current, complete, and valid for all config files."""

import json
import os
import re

import pytest
import yaml
from jsonschema import Draft202012Validator
from project import CONFIG_FILES, ROOT, config_file, read_config

from conveyor_pipeline.config.schema import full_schema, json_schema, options_of, schema_at, unit_of
from conveyor_pipeline.pages.config_keys import list_keys, parse_file

SCHEMA = json.loads(json_schema())
FILES = [config_file(name) for name in (*CONFIG_FILES, "config", "reduced")]
EXAMPLES = sorted((ROOT / "config/examples").glob("*.yaml"))


def accepts(config: dict) -> bool:
    return Draft202012Validator(SCHEMA).is_valid(config)


def test_the_committed_schema_is_current():
    assert (ROOT / "config/schema.json").read_text(encoding="utf-8") == json_schema(), (
        "write conveyor_pipeline.config.schema.json_schema() to config/schema.json"
    )


@pytest.mark.parametrize("file", [*FILES, *EXAMPLES], ids=lambda file: file.stem)
def test_config_files_name_their_schema_and_fulfil_it(file):
    place = os.path.relpath(ROOT / "config/schema.json", file.parent)
    text = file.read_text(encoding="utf-8")
    assert text.startswith(f"# yaml-language-server: $schema={place}\n")
    assert accepts(yaml.safe_load(text))


@pytest.mark.parametrize(
    "overlay",
    [
        {"model": {"mass": -1.0}},
        {"model": {"angle": 12}},
        {"sweep": {}},
        {"sweeps": {"mine": {"needs": "speed"}}},
        {"sweeps": {"my sweep": {}}},
        {"sweeps": {"mine": {"axes": {"z0": "high"}}}},
        {"figures": {"fig23": {"settings": {"portraits": [[40.0, 0.0], [40.0, 99.0], [80.0, 0.0]]}}}},
    ],
    ids=str,
)
def test_the_schema_rejects_wrong_values(overlay):
    assert not accepts(overlay)


def test_overlays_may_name_some_keys_only():
    assert "required" not in {key for part in every_part(SCHEMA) for key in part if not isinstance(part[key], dict)}
    assert accepts({})
    assert accepts({"sweeps": {"amplitudes": {"axes": {"acceleration": {"num": 3}}}}})


def every_part(value):
    """All mappings below a value."""
    if isinstance(value, dict):
        yield value
        value = list(value.values())
    for item in value if isinstance(value, list) else ():
        yield from every_part(item)


def test_every_key_has_a_description():
    places = [part["properties"] for part in every_part(SCHEMA) if isinstance(part.get("properties"), dict)]
    lacking = [
        name
        for place in places
        for name, item in place.items()
        if not any("description" in one for one in options_of(item))
    ]
    assert len(places) > 40  # also without the floor machine
    assert lacking == []


def test_the_schema_has_units():
    assert unit_of(schema_at(["model", "mass"])) == "kg"
    assert unit_of(schema_at(["sweeps", "mine", "axes", "z0", "start"])) == "m"
    assert unit_of(schema_at(["figures", "fig23", "settings", "portraits", 0, 1])) == "m"
    assert schema_at(["model", "weight"]) == {}


def test_the_schema_has_every_key_of_the_default_config():
    for key in (key for file in FILES for key in parse_file(file.read_text(encoding="utf-8"))):
        assert schema_at(list(key.path)), key.path


def test_the_page_of_keys_has_all_sections_with_values_and_units():
    found = list(list_keys(SCHEMA))
    assert list(dict.fromkeys(key.path[0] for key in found)) == list(full_schema()["properties"])
    # Without the section body, parts are points.
    assert {key.path[0] for key in found} - {"body"} == set(read_config())
    assert all(re.search("[a-z]", key.allowed) and key.description for key in found)
    by_name = {".".join(key.path): key[1:] for key in found}
    assert by_name["model.mass"] == ("number in [1e-12, 1e+06]", "kg", "mass of the part, m_p")
    assert by_name["solver.duration"][:2] == ("number in (0, 1e+06]", "s")
    assert by_name["sweeps.NAME.needs"][0] == "feeding, vertical"
    assert by_name["critical.NAME.scan"][:2] == ("list; each item: number in [-1, 10], or {start, stop, num}", "m")
    assert by_name["orbits.seeds.[].z0"][:2] == ("number in [-1, 10], or conveyor", "m")
    assert by_name["companion.presets.NAME"][0] == "keys of `model`"
