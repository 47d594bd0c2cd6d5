"""Products of axes as parameter vectors."""

import numpy as np

from conveyor import Conveyor, Start, conveyor_and_start
from conveyor_pipeline.common import grid

AXES = {"acceleration": {"start": 30, "stop": 40, "num": 3}, "tension": ["allow", "clip"], "z0": [0.0, "conveyor"]}


def test_first_axis_is_slowest_and_ends_are_included():
    columns, parameters = grid.product(AXES, {"damping": 0.2, "vz0": 0.1})
    assert list(columns) == list(AXES)
    assert columns["acceleration"].tolist() == [30.0] * 4 + [35.0] * 4 + [40.0] * 4
    assert columns["tension"].tolist() == ["allow", "allow", "clip", "clip"] * 3
    np.testing.assert_array_equal(columns["z0"], [0.0, np.nan] * 6)
    assert parameters.shape == (12,)


def test_parameters_agree_with_the_model():
    _, parameters = grid.product(AXES, {"damping": 0.2, "vz0": 0.1})
    assert conveyor_and_start(parameters[7]) == (
        Conveyor(acceleration=35.0, damping=0.2, static_friction=0.15, tension="clip"),
        Start(z="conveyor", vz=0.1),
    )


def test_parts_of_a_product_make_the_whole():
    columns, parameters = grid.product(AXES, {})
    parts = [grid.product(AXES, {}, rows) for rows in ((0, 5), (5, 6), (6, 12))]
    assert np.concatenate([part for _, part in parts]).tobytes() == parameters.tobytes()
    for name, column in columns.items():
        np.testing.assert_array_equal(np.concatenate([part[name] for part, _ in parts]), column)
