"""Materials and the stiffness of a Hertz contact."""

import math

import pytest

from conveyor import Conveyor, Start, hertz_stiffness, material, simulate
from conveyor.materials import HARDNESS, materials, shore_modulus


def test_materials_have_a_source_and_a_modulus_within_its_range():
    for name, one in materials().items():
        assert one.name == name
        assert 0.0 < one.low < one.modulus < one.high < 2.0 * one.low or name.startswith(("PA", "POM", "PE", "PP"))
        assert one.low < one.modulus < one.high
        assert 0.0 < one.poisson <= 0.5
        assert "," in one.source and any(digit in one.source for digit in "B1")
        assert one.description


def test_needed_materials_are_there():
    assert {"steel", "stainless_steel", "aluminium", "brass", "PP", "PE_HD", "POM", "PA", "glass"} <= set(materials())
    for name in ("rubber_60A", "polyurethane_85A", "polyurethane_60D"):
        assert material(name).poisson == 0.5
        assert material(name).source


def test_modulus_of_a_shore_hardness():
    """Gent's formula at Shore A 40, 60, 85; the other formula at Shore D 50, that is 100 in its argument."""
    assert [round(shore_modulus(a, "A") / 1e6, 2) for a in (40, 60, 85)] == [1.69, 3.61, 13.18]
    assert shore_modulus(50, "D") / 1e6 == pytest.approx(10.0**1.7097)
    for scale, (least, most) in HARDNESS.items():
        values = [shore_modulus(hardness, scale) for hardness in range(least, most + 1)]
        assert values == sorted(values) and values[0] > 0.0


def test_the_two_formulas_differ_by_less_than_the_stated_factor():
    ratios = [10.0 ** (0.0235 * a - 0.6403) / (shore_modulus(a, "A") / 1e6) for a in range(20, 96)]
    assert min(ratios) > 1.0 / 1.9
    assert 1.8 < max(ratios) < 1.9


def test_stiffness_of_a_sphere_on_a_half_space():
    """F = (4/3) E* √R δ^1.5 with two equal materials: E* = E/(2 (1 - ν²))."""
    expected = 4.0 / 3.0 * 200e9 / (2.0 * (1.0 - 0.09)) * math.sqrt(0.01)
    assert hertz_stiffness((200e9, 0.3), (200e9, 0.3), 0.01) == pytest.approx(expected, rel=1e-14)
    assert hertz_stiffness("steel", "PP", 1e-3) == hertz_stiffness(material("PP"), (207e9, 0.30), 1e-3)


def test_a_part_rests_at_the_depth_of_hertz():
    """The solver's part at rest: m g = k_c δ^1.5."""
    stiffness = hertz_stiffness("steel", "polyurethane_85A", 1.5e-3)
    conveyor = Conveyor(acceleration=0.0, mass=0.8e-3, stiffness=stiffness, damping=0.5)
    run = simulate(conveyor, Start(z=0.0), duration=2.0)
    assert run.z_end == pytest.approx(-((0.8e-3 * 9.81 / stiffness) ** (2.0 / 3.0)), rel=1e-9)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("stel", "PP", 1e-3), "name = 'stel' is not one of steel, "),
        (("steel", "rubber_99A", 1e-3), "name = 'rubber_99A' must have a hardness Shore A from 20 to 95"),
        (("steel", "PP", 0.0), r"radius = 0.0 must be a number in \(0, 0.5\] m"),
        (("steel", "PP", True), "radius = True must be"),
        ((210e9, "PP", 1e-3), "part = 210000000000.0 must be a material, or a modulus in Pa and Poisson's ratio"),
        (("steel", (210.0, 0.3), 1e-3), r"lining = \(210.0, 0.3\) must have a modulus in \[10000, 2e\+12\] Pa"),
        (("steel", "PP", 1.5), r"radius = 1.5 must be a number in \(0, 0.5\] m"),
        (("steel", (1e9, 0.7), 1e-3), r"lining = \(1000000000.0, 0.7\) must have a modulus in"),
        (((1e4, 0.3), "PP", 1e-9), "radius = 1e-09 m gives a stiffness of 0.463 N/m"),
    ],
)
def test_impossible_contacts_are_refused(arguments, message):
    with pytest.raises(ValueError, match=message):
        hertz_stiffness(*arguments)
