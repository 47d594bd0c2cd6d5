"""Errors in the sections of the floor machine."""

import pytest
from project import ROOT, assert_reported, merged, read_config

from conveyor_pipeline.config import canonical, problems

# An overlay, and a part of the expected message.
WRONG = [
    (
        {"operating": {"acceleration": ["0.5 mm peak to peak"]}, "model": {"frequency": 100}},
        "0.5 mm zero to peak are 197.4 m/s², and 0.5 mm peak to peak are 98.7 m/s²",
    ),
    ({"model": {"frequency": 0.05}}, "SI units follow from model.frequency and model.angle: are they right?"),
    ({"body": {"length": "5 mm", "tilt": 0.1}}, "body.height is missing; give it in m (height of the part)"),
    (
        {"parts": {"friction": 15}},
        "parts.friction = 15 should be at most 1 (of the value in the model); this is a share: write 15 % or 0.15",
    ),
    ({"advice": {"margin": 2.5}}, "(of the amplitude); this is a share: write 2.5 % or 0.025"),
    ({"drive": {"back": 5}}, "(of the parts); this is a share: write 5 % or 0.05"),
    ({"calibration": {"noise": "3"}}, "(of the velocity); this is a share: write 3 % or 0.03"),
    ({"calibration": {"ranges": {"angle": [0.1, 16]}}}, "16° are 0.2793 rad"),
    ({"calibration": {"ranges": {"friction": [0.4, 0.1]}}}, "is reversed"),
    (
        {"transit": {"longest": 0.01}},
        "transit.longest = 0.01 s is shorter than the longest excitation cycle of model and drive.bounds (0.025 s)",
    ),
    ({"calibration": {"effort": 0}}, "calibration.effort = 0 should be at least 0.05"),
    (
        {
            "prefix": "mine",
            "model": {"friction": 0.02, "static_friction": 0.03},
            "calibration": {"measurements": str(ROOT / "config/examples/measured.csv")},
        },
        "model.static_friction = 0.03 leaves no friction to search, because calibration.ranges.friction begins at 0.04",
    ),
    (
        {
            "prefix": "mine",
            "contact": {"restitution": 0.8},
            "calibration": {"measurements": str(ROOT / "config/examples/measured.csv")},
        },
        "calibration.parameters has damping, which the section contact gives; take it out of the parameters",
    ),
    (
        {"clean_drive": {"shares": [0.02, 0.1]}},
        "clean_drive.shares = [0.02, 0.1] lacks 0.05, the share of the statement on chaos; add it",
    ),
    ({"advice": {"part_length": 5.0}}, "advice.part_length = 5.0 m is longer than the track, transit.length = 0.5 m"),
    (
        {"body": {"length": 5, "height": 2, "tilt": 0.1}},
        "body.length = 5.0 m is longer than the track, transit.length = 0.5 m; write 5 mm",
    ),
    (
        {"transit": {"length": 500}},
        "transit.length = 500.0 m is too long for transit.longest = 20.0 s, because the plate moves at most at 0.4",
    ),
    (
        {"transit": {"length": 0.2}, "model": {"angle": "90 deg"}},
        "because the plate does not move along the track; give a smaller model.angle",
    ),
    ({"parts": {"calibrated": True}}, "parts.calibrated needs measurements; name the config with"),
    (
        {"transit": {"length": 500}, "model": {"inclination": -0.1}},
        "transit.length = 500.0 m is too long for transit.longest = 20.0 s",
    ),
    (
        {"transit": {"length": 500}, "model": {"inclination": 0.3}},
        "transit.length = 500.0 m is too long for transit.longest = 20.0 s",
    ),
    ({"drive": {"velocity": 20.0}}, "drive.velocity = 20.0 m/s cannot be reached, because the plate moves at most at"),
    ({"advice": {"changes": {"inclination": 5}}}, "5° are 0.0873 rad: write 5 deg"),
    ({"drive": {"velocity": 0}}, "drive.velocity = 0 should be more than 0 (m/s)"),
    ({"drive": {"velocity": 200.0}}, "drive.velocity = 200.0 should be at most 100 (m/s)"),
    ({"transit": {"acceleration": {"num": 1}}}, "has num: 1 for two ends; give more values, or a list such as [19.0]"),
]


@pytest.mark.parametrize(
    ("overlay", "message"),
    [
        ({"body": {"length": "600 mm", "height": "20 mm", "tilt": 0.1}}, "transit.length = 0.5 m; give a longer"),
        ({"transit": {"length": "500 m"}}, "m/s; give a shorter track, or give more time"),
    ],
)
def test_lengths_with_a_unit_are_not_taken_for_millimetres(overlay, message):
    (line,) = problems(merged(read_config(), overlay), stated=overlay)
    assert message in line and "write" not in line


@pytest.mark.parametrize(("overlay", "message"), WRONG, ids=[message[:40] for _, message in WRONG])
def test_an_error_names_key_and_remedy(overlay, message):
    assert_reported(overlay, message)


def test_parts_may_slide_down_a_long_track():
    """At an inclination of 0.3 rad, the friction of 0.15 does not stop them."""
    overlay = {"prefix": "mine", "transit": {"length": 500}, "model": {"inclination": -0.3}}
    assert problems(merged(read_config(), overlay)) == []


def test_numbers_of_the_machine_may_have_a_unit():
    transit = {"acceleration": {"start": "1 g", "stop": "9 g"}, "length": "50 cm"}
    shares = {"parts": {"friction": "10 %"}, "advice": {"margin": "2 %"}}
    own = canonical(merged(read_config(), {"prefix": "mine", "transit": transit, **shares}))
    transit = {"acceleration": {"start": 9.80665, "stop": 88.25985}, "length": 0.5}
    shares = {"parts": {"friction": 0.1}, "advice": {"margin": 0.02}}
    assert own == canonical(merged(read_config(), {"prefix": "mine", "transit": transit, **shares}))
