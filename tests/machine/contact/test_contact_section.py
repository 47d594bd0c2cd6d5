"""The contact of a config from materials and a drop, and the page about it."""

import math

import pandas as pd
import pytest
import yaml
from project import ROOT, dry_run, merged, read_config
from scipy.integrate import solve_ivp

from conveyor import Conveyor, damping_of, hertz_stiffness, restitution
from conveyor.materials import ELASTOMERS, HARDNESS, materials
from conveyor_pipeline.common import tables
from conveyor_pipeline.common.templates import format_plain
from conveyor_pipeline.config import canonical, load_config, problems
from conveyor_pipeline.config.files import DEFAULT_FILES
from conveyor_pipeline.config.schema import schema_at
from conveyor_pipeline.config.tables import settings_of
from conveyor_pipeline.machine.contact import page, variants

CONFIG = read_config()
MODEL = {"mass": 0.8e-3, "frequency": 100.0, "angle": 0.35, "inclination": 0.05}
WORDS = {"part": "steel", "lining": "polyurethane_85A", "radius": 1.5e-3, "restitution": 0.5, "drop_height": 0.02}
MINE = {"prefix": "mine", "model": MODEL, "contact": WORDS}


def model_of(contact, **model):
    overlay = {"prefix": "mine", "model": MODEL | model, "contact": contact}
    assert problems(merged(CONFIG, overlay), stated=overlay) == []
    return canonical(merged(CONFIG, overlay))["model"]


def test_materials_give_the_stiffness_and_a_drop_the_damping():
    model = model_of(WORDS)
    assert model["stiffness"] == pytest.approx(hertz_stiffness("steel", "polyurethane_85A", 1.5e-3), rel=1e-5)
    level = Conveyor(**{key: model[key] for key in ("mass", "stiffness", "damping")})
    assert restitution(level, math.sqrt(2.0 * 9.81 * 0.02)) == pytest.approx(0.5, abs=1e-5)


@pytest.mark.parametrize("tension", ["allow", "clip"])
def test_each_half_is_allowed_alone(tension):
    model = model_of({"restitution": 0.6, "drop_height": "50 mm"}, stiffness=2e6, tension=tension)
    level = Conveyor(mass=0.8e-3, stiffness=2e6, tension=tension)
    assert model["stiffness"] == 2e6
    assert model["damping"] == pytest.approx(damping_of(0.6, math.sqrt(2.0 * 9.81 * 0.05), level), rel=1e-5)
    own = {"modulus": "2 GPa", "poisson": 0.4}
    model = model_of({"part": own, "lining": "stainless_steel", "radius": "3 mm"}, damping=0.7)
    assert model["damping"] == 0.7
    assert model["stiffness"] == pytest.approx(hertz_stiffness((2e9, 0.4), "stainless_steel", 3e-3), rel=1e-5)


def test_a_value_that_agrees_may_be_stated_and_null_leaves_a_half_out():
    damping = model_of(WORDS)["damping"]
    assert model_of(WORDS, damping=round(damping, 4))["damping"] == damping
    assert model_of(WORDS | {"restitution": None}, damping=3.0)["damping"] == 3.0


@pytest.mark.parametrize(
    ("contact", "model", "message"),
    [
        ({"restitution": 0.5}, {"damping": 3.0}, "model.damping = 3.0 contradicts the section contact, which gives 0."),
        ({"restitution": 0.5}, {"damping": 0.3}, "model.damping = 0.3 contradicts the section contact"),
        (WORDS, {"stiffness": 1e6}, "contradicts the section contact, which gives 907567.0 N/m^1.5; remove it"),
        (WORDS | {"drop_height": 20.0}, {}, "contact.drop_height = 20.0 should be at most 1 (m)"),
        (WORDS | {"radius": 1.5}, {}, "contact.radius = 1.5 should be at most 0.5 (m)"),
        (
            {"part": "steel", "radius": 1e-3},
            {},
            "contact.lining is missing; part, lining and radius give the stiffness together; name its material, or "
            "remove part and radius",
        ),
        ({"radius": 1e-3}, {}, "give the stiffness together; name its material, or remove radius"),
        ({"part": "steel", "lining": "PP"}, {}, "together; give it in m, or remove part and lining"),
        (
            {"part": "steel", "lining": "rubber_60A", "radius": 1e-15},
            {},
            "contact.radius = 1e-15 m gives a stiffness of 0.203 N/m^1.5, outside [1, 1e+15]; give another radius",
        ),
        ({**WORDS}, {"exponent": 1.0}, "contact.radius needs a Hertz contact, but model.exponent is 1.0"),
        ({"part": "stel"}, {}, "contact.part = 'stel' should be one of steel, stainless_steel"),
        ({"lining": "rubber_99A"}, {}, "contact.lining = 'rubber_99A' should be one of steel"),
        ({"part": 7}, {}, "contact.part = 7 should be the name of a material, or {modulus: …, poisson: …}"),
        ({"radius": "3 g"}, {}, "contact.radius = '3 g' has a unit of another dimension; give m, mm"),
        ({"restitution": 1.2}, {}, "contact.restitution = 1.2 should be at most 1"),
        (
            {"restitution": 1e-5},
            {"mass": 1e6, "stiffness": 1e15},
            "contact.restitution = 1e-05 needs more than the largest damping, 1e+06 N s/m",
        ),
    ],
)
def test_contradictions_are_refused_with_what_would_fit(contact, model, message):
    overlay = {"prefix": "mine", "model": MODEL | model, "contact": contact}
    lines = problems(merged(CONFIG, overlay), stated=overlay)
    assert any(message in line for line in lines), lines


def test_the_schema_knows_all_materials():
    pattern = next(one["pattern"] for one in schema_at(["contact", "part"])["anyOf"][0]["oneOf"] if "pattern" in one)
    names = [
        *materials(),
        *(f"{name}_{hardness}{scale}" for name in ELASTOMERS for scale, ends in HARDNESS.items() for hardness in ends),
    ]
    outside = [
        f"rubber_{hardness}{scale}" for scale, (low, high) in HARDNESS.items() for hardness in (low - 1, high + 1)
    ]
    import re

    assert all(re.search(pattern, name) for name in names)
    assert not any(re.search(pattern, name) for name in outside)


def test_the_origin_of_a_derived_value_is_shown(tmp_path, capsys):
    from conveyor_pipeline.config.__main__ import show

    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(MINE, sort_keys=False))
    loaded = load_config([str(file)], {})
    lines = list(show(loaded.merged, loaded.stated, [*map(str, DEFAULT_FILES), str(file)]))
    assert f"model.stiffness = 907567.0 N/m^p    # {file}:7: from the section contact" in lines


def made(overlay, impact_speed=0.2):
    """The settings of the table of variants, and an advice of one amplitude."""
    settings = settings_of(canonical(merged(CONFIG, overlay)), "contact/variants")
    found = pd.DataFrame({"aim": ["fast"], "acceleration": [60.0], "impact_speed": [impact_speed]})
    return settings | {"starts": 16, "longest": 2.0, "length": 0.05}, found


def test_no_contact_bounces_higher_than_the_part_fell():
    found = variants.contacts(made(MINE | {"contact": {**MINE["contact"], "restitution": 1.0}})[0])
    assert "bounces more" not in found
    assert {found[name]["damping"] for name in ("stated", "softer", "stiffer")} == {0.0}
    assert found["bounces less"]["damping"] > 0.0


def test_variants_keep_the_bounce_or_the_stiffness():
    settings, _ = made(MINE)
    found = variants.contacts(settings)
    assert list(found) == list(variants.VARIANTS)
    stated = found["stated"]
    low, high = variants.stiffness_range(settings)
    assert low < stated["stiffness"] / 2.0 and high > 2.0 * stated["stiffness"]
    for name, one in found.items():
        level = Conveyor(mass=0.8e-3, stiffness=one["stiffness"], damping=one["damping"])
        assert restitution(level, math.sqrt(2.0 * 9.81 * 0.02)) == pytest.approx(one["drop"], abs=1e-6), name
    assert [round(found[name]["drop"], 3) for name in ("softer", "stiffer")] == [0.5, 0.5]
    assert [round(found[name]["drop"], 3) for name in ("bounces less", "bounces more")] == [0.45, 0.55]


@pytest.mark.parametrize("plate", [0.0, 30.0])
def test_an_impact_presses_no_deeper_than_the_page_says(plate):
    """A part that falls onto a plate which accelerates evenly upwards, as gravity that much larger would act."""
    model = {"mass": 0.05, "stiffness": 4e5, "exponent": 1.5, "gravity": 9.81}
    deepest = variants.penetration(model, 0.3, plate)

    def rates(_, state):
        return state[1], 9.81 + plate - model["stiffness"] / model["mass"] * max(state[0], 0.0) ** 1.5

    run = solve_ivp(rates, (0.0, 5e-3), [0.0, 0.3], rtol=1e-10, atol=1e-14, max_step=1e-5)
    assert deepest == pytest.approx(run.y[0].max(), rel=1e-4)


@pytest.mark.parametrize(
    "overlay", [MINE, {"prefix": "mine", "model": MODEL}, {"prefix": "mine", "model": MODEL | {"damping": 30.0}}]
)
def test_the_page_names_both_values_and_what_is_uncertain(overlay):
    settings, advice = made(overlay, 0.2 if "contact" in overlay else 0.0)
    rows = variants.make(advice, settings)
    table = tables.make("variants", variants.TABLES["variants"], rows, settings)
    frame = table.to_pandas()
    frame.attrs = settings
    assert (frame.acceleration == 60.0).all()
    text = page.make((ROOT / "workflow/rules/machine/contact.md").read_text(encoding="utf-8"), frame, advice)
    model = settings["model"]
    assert f"**k_c = {format_plain(model['stiffness'], 3)} N/m^1.5 and d_c = {model['damping']:.3g} N s/m.**" in text
    assert "Hertz's formula does not hold" in text
    assert "| in the drop of 20 mm | 62.6 |" in text
    assert ("Gent (1958)" in text) == ("The part bounces" not in text and "contact" in overlay)
    assert "nan" not in text.lower().replace("nano", "")


def test_without_advice_nothing_is_compared():
    settings, advice = made(MINE)
    frame = pd.DataFrame(variants.make(advice.head(0), settings))
    frame.attrs = settings
    text = page.make((ROOT / "workflow/rules/machine/contact.md").read_text(encoding="utf-8"), frame, advice.head(0))
    assert "There is no advised amplitude" in text


def test_the_target_machine_has_the_page_for_a_config_with_a_contact(tmp_path):
    """And only for one: tests/machine/test_own_machine.py lists the rules for a conveyor without a contact."""
    assert "results/mine/contact.md" in dry_run(MINE, tmp_path, "machine").stdout
