"""Parts as blocks: starts above the plate, transit and advice of blocks, and the tables of shapes."""

import math

import numpy as np
import pandas as pd
import pytest
from project import si_config

from conveyor import Block, simulate_block
from conveyor.analysis.map_states import plate_heights
from conveyor_pipeline.machine import checks
from conveyor_pipeline.machine.operating import advice, bodies, body_limits, parts, populations, transit
from conveyor_pipeline.machine.operating.settings import TABLE_SETTINGS

BODY = {"length": 5e-3, "height": 1e-3, "tilt": 0.03}
SETTINGS = TABLE_SETTINGS["operating/transit"]({**si_config(), "body": BODY}) | {"starts": 12, "longest": 4.0}


def test_no_block_begins_in_the_plate():
    rows, block = parts.population(np.array([40.0]), SETTINGS), Block(BODY["length"], BODY["height"])
    tilts = parts.tilts_of(SETTINGS)
    assert (np.abs(tilts) <= BODY["tilt"]).all() and tilts.min() < 0.0 < tilts.max()
    raised = parts.raise_blocks(rows, block, tilts)
    half = 0.5 * np.array([BODY["length"], BODY["height"]])
    lowest = half[1] * (1.0 - np.cos(tilts)) - half[0] * np.abs(np.sin(tilts))
    assert (raised["z0"] - plate_heights(rows) + lowest >= -1e-12).all()
    assert (raised["z0"] >= rows["z0"]).all()
    level = parts.raise_blocks(rows, block, np.zeros(len(rows)))
    np.testing.assert_array_equal(level["z0"], rows["z0"])


def test_a_flat_block_does_not_jump_where_points_ride_or_jump():
    settings = SETTINGS | {"length": 0.1}
    blocks = transit.measure(np.array([40.0]), settings, (populations.IDENTICAL,)).iloc[0]
    points = {name: value for name, value in settings.items() if name != "body"}
    masses = transit.measure(np.array([40.0]), points, (populations.IDENTICAL,)).iloc[0]
    assert blocks.failed == masses.failed == 0
    assert blocks.velocity_75 < 0.02 < masses.velocity_75


def test_an_upright_block_that_is_tiny_moves_as_its_place_in_the_population_says():
    """Populations below each other have the same tilts, and do not depend on threads."""
    settings = SETTINGS | {"length": 0.02, "longest": 1.0}
    rows = np.concatenate([parts.population(np.array([80.0]), settings)] * 2)
    one, other = (transit.follow_parts(rows, settings, threads=threads) for threads in (1, 2))
    np.testing.assert_array_equal(one.velocity, other.velocity)
    np.testing.assert_array_equal(one.velocity[:12], one.velocity[12:])


def test_tall_blocks_tip_over_and_flat_ones_do_not():
    tall = SETTINGS | {"body": {"length": 2e-3, "height": 6e-3, "tilt": 0.02}, "length": 0.02, "longest": 1.0}
    found = [transit.measure(np.array([60.0]), own, (populations.IDENTICAL,)).tipped[0] for own in (tall, SETTINGS)]
    assert found == [1.0, 0.0]


def test_blocks_that_fall_back_have_not_tipped_over():
    """On a track that falls, a cube may lean back farther than 45° without tipping over."""
    model = SETTINGS["model"] | {"inclination": -0.3}
    own = SETTINGS | {"model": model, "body": {"length": 2e-3, "height": 2e-3, "tilt": 1.0}, "longest": 0.3}
    own |= {"height": [0.0, 0.0], "vz0": [0.0, 0.0]}
    rows = parts.population(np.array([10.0]), own, populations.IDENTICAL)
    block, tilts = Block(2e-3, 2e-3), parts.tilts_of(own)
    ends = [
        simulate_block(row, block, tilt=tilt, duration=0.3).sample(0.3)["angle"]
        for row, tilt in zip(parts.raise_blocks(rows, block, tilts), tilts.tolist(), strict=True)
    ]
    tipped = np.abs(ends) > 1.0
    assert transit.follow_blocks(rows, own).tipped.tolist() == tipped.tolist()
    assert tilts[~tipped].max() > np.pi / 4


def test_the_advice_says_what_it_would_be_for_points():
    settings = SETTINGS | {"length": 0.02, "longest": 1.0, "starts": 8}
    table = transit.measure(np.array([40.0, 80.0]), settings)
    table.attrs = settings
    shares = pd.DataFrame({"acceleration": [40.0], "state": ["second"], "share": [1.0]})
    found = advice.make(table, shares, {"range": (0.99, 1.01), "changes": {}})["advice"]
    assert found["point_acceleration"][0] in (40.0, 80.0)
    assert np.isfinite(found["point_velocity"][0])


def test_tables_of_shapes():
    config = si_config()
    settings = TABLE_SETTINGS["operating/bodies"]({**config, "bodies": {"effort": 0.1}})
    tables = bodies.make(settings)
    curves, shapes, landing = (tables[name] for name in ("bodies", "body_shapes", "landing"))
    assert len(curves) == 3 * (1 + len(bodies.SHAPES)) and len(shapes) == 4 * len(body_limits.MOTIONS)
    assert (curves.failed == 0).all() and (shapes.failed == 0).all()
    assert curves.largest_tilt.isna().sum() == 3
    assert (shapes[shapes.motion == "ride"].rides == 1.0).all()
    # The block touches the plate with one corner at the time zero.
    first = landing[landing.time == 0.0].iloc[0]
    assert min(first.rear, first.front) == pytest.approx(first.plate, abs=1e-6)


def test_the_difference_of_two_medians_has_the_errors_of_both():
    blocks = {"velocity_50": 0.11, "velocity_50_stderr": 0.003}
    points = {"velocity_50": 0.1, "velocity_50_stderr": 0.004}
    expected = {"difference": 0.1, "difference_stderr": math.hypot(0.03, 1.1 * 0.04)}
    assert bodies.relative_difference(blocks, points) == pytest.approx(expected)
    assert np.isnan([*bodies.relative_difference(blocks, points | {"velocity_50": 0.0}).values()]).all()


def test_a_part_length_that_contradicts_the_body_is_refused():
    config = si_config()
    own = {**config, "body": BODY, "advice": {**config["advice"], "part_length": 0.02}}
    (fault,) = checks.bodies(own, config, {})
    assert "body.length = 0.005" in fault
    assert not list(checks.bodies({**config, "body": BODY}, config, {}))
