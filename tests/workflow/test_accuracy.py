"""Stages that compare the solver with other methods: what they find, on the cases of the config."""

import numpy as np
import pytest

import benchmark
import random_points
from project import merged, read_config

CONFIG = read_config()


@pytest.fixture(scope="module")
def cases():
    solver = {key: CONFIG["solver"][key] for key in ("duration", "tolerance", "step")}
    return {
        name: merged({"model": CONFIG["model"]}, solver, case) for name, case in CONFIG["benchmark"]["cases"].items()
    }


def test_benchmark_is_as_accurate_as_wanted(cases):
    found = benchmark.columns(cases, 1)
    wanted = np.array([case["wanted"]["error"] for case in cases.values()])
    assert (found["error"] <= wanted).all()
    assert (found["euler_error"] > 1e4 * found["error"]).all()
    np.testing.assert_array_equal(found["euler_steps"], [case["duration"] / case["step"] for case in cases.values()])
    assert (found["steps"] < 1e-3 * found["euler_steps"]).all()
    # Faster than the paper's method by far on any machine; how far is what results/benchmark.md is for.
    assert (found["speed"] > 10.0).all()
    lines = benchmark.report(found, cases, 1).splitlines()
    assert [line.split(" | ")[0] for line in lines if line.startswith("| ") and "Case" not in line] == [
        f"| {name}" for name in cases
    ]


def test_random_points_know_how_deep_they_get():
    found = random_points.columns({"count": 300, "seed": 3, "duration": 0.05, "tolerance": 1e-8})
    ok = found["status"] == "ok"
    assert ok.all()
    assert np.isfinite(found["max_depth"]).all()
    assert (found["max_depth"] <= found["allowed_depth"]).all()
    # A part that starts on the plate and is pressed on gets into it.
    on_plate = np.isnan(found["z0"]) & (found["vz0"] < 0.0)
    assert on_plate.any()
    assert (found["max_depth"][on_plate] > 0.0).all()
