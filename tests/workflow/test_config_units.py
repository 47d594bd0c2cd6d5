"""Numbers of the config with a unit of the user's choice."""

import math
import subprocess
import sys

import pytest
from project import ROOT, merged, read_config

from conveyor_pipeline.common.quantities import KEYS, QuantityError, exponent_of, in_unit, is_quantity
from conveyor_pipeline.config import canonical, problems
from conveyor_pipeline.config.__main__ import origin_of
from conveyor_pipeline.config.schema import full_schema

CONFIG = read_config()


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("20 deg", "rad", math.radians(20.0)),
        ("20°", "rad", math.radians(20.0)),
        ("4 g", "m/s²", 4.0 * 9.80665),
        ("50 mg", "m/s²", 0.05 * 9.80665),
        ("50 mg", "kg", 50e-6),
        ("3 m/s2", "m/s²", 3.0),
        ("1500 rpm", "Hz", 25.0),
        ("85 %", "1", 0.85),
        ("15%", "of the value in the model", 0.15),
        ("0.5 Ns/mm", "N s/m", 500.0),
        ("-5e-1 mm", "m", -0.5e-3),
        ("800 N/mm", "N/m^p", 8e5),
        ("5 N/mm^1.5", "N/m^p", 5.0 * 1000.0**1.5),
    ],
)
def test_a_text_has_the_value_of_its_unit(text, unit, value):
    assert in_unit(text, unit) == pytest.approx(value, rel=1e-14)


def test_a_right_angle_is_no_more_than_one():
    assert in_unit("90 deg", "rad") == 0.5 * math.pi


@pytest.mark.parametrize(
    ("text", "unit"),
    [("3 %", "rad"), ("3 rad", "1"), ("314 rad/s", "Hz"), ("3 N", "m"), ("3 mm mm", "m"), ("4 g", "m"), ("3 mm", "1")],
)
def test_another_dimension_is_refused_with_the_expected_unit(text, unit):
    with pytest.raises(QuantityError, match="has a unit of another dimension; give "):
        in_unit(text, unit)


@pytest.mark.parametrize("text", ["3 ##", "3 m(", "3 furlong", "3 m**m", "3 __import__('os')"])
def test_an_unknown_unit_is_refused(text):
    with pytest.raises(QuantityError, match="has an unknown unit; give m, mm"):
        in_unit(text, "m")


def test_a_converted_number_is_the_one_that_a_user_would_write():
    assert [in_unit(f"0.{n} mm", "m") for n in range(1, 10)] == [float(f"{n}e-4") for n in range(1, 10)]


def test_the_exponent_of_a_stiffness_follows_from_its_unit():
    assert [exponent_of(text) for text in ("5e5 N/m^1.5", "800 N/mm", "3 N/m**2", "3 N", "3 mm")] == [
        1.5,
        1.0,
        2.0,
        0.0,
        None,
    ]


def units_of_numbers(schema):
    """The units of all numbers of a schema."""
    if isinstance(schema, dict):
        if schema.get("type") == ["number", "string"]:
            yield schema.get("unit", "")
        schema = list(schema.values())
    for part in schema if isinstance(schema, list) else ():
        yield from units_of_numbers(part)


def test_each_number_of_the_config_has_a_known_unit_or_is_a_share():
    units = set(units_of_numbers(full_schema()))
    assert set(KEYS) - {"Pa"} <= units
    assert {unit for unit in units - set(KEYS) if not unit.startswith("of ")} <= {"", "1"}


def test_every_number_of_an_overlay_may_have_a_unit():
    overlay = {
        "prefix": "mine",
        "model": {"angle": "20 deg", "mass": "0.8 g", "frequency": "1500 rpm", "z0": "0.3 mm", "friction": "15 %"},
        "sweeps": {"mine": {"axes": {"z0": ["0 mm", "conveyor"], "stiffness": ["5e5 N/m^1.5"]}}},
    }
    plain = {
        "prefix": "mine",
        "model": {"angle": math.radians(20.0), "mass": 0.8e-3, "frequency": 25.0, "z0": 0.3e-3, "friction": 0.15},
        "sweeps": {"mine": {"axes": {"z0": [0.0, "conveyor"], "stiffness": [5e5]}}},
    }
    assert problems(merged(CONFIG, overlay)) == []
    own, other = (canonical(merged(CONFIG, one)) for one in (overlay, plain))
    assert own["model"].pop("angle") == pytest.approx(other["model"].pop("angle"), rel=1e-14)
    assert own == other


def test_pint_is_imported_only_for_such_a_text():
    code = (
        "import sys; from conveyor_pipeline.config import checks; assert checks.problems(checks.default_config()) == []"
    )
    code += "; assert not {'pint', 'numpy', 'numba', 'scipy'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT / "scripts")


@pytest.mark.parametrize("text", ["1e5", "1E+5", ".5e5"])
def test_a_number_that_is_a_text_to_yaml_1_1_is_no_quantity(text):
    """As a module, or with --config, Snakemake hands over such texts."""
    assert not is_quantity(text)
    overlay = {"prefix": "mine", "model": {"stiffness": text}}
    assert problems(merged(CONFIG, overlay)) == []
    assert canonical(merged(CONFIG, overlay))["model"]["stiffness"] == float(text)


def test_the_origin_of_a_converted_value_is_its_dimensionless_one():
    lines = {("operating", "dimensionless", "height"): "defaults:3", ("operating",): "mine:1", ("transit",): "mine:2"}
    assert origin_of(("operating", "height"), lines) == "defaults:3"
    assert origin_of(("transit", "acceleration", "num"), lines) == "mine:2"
