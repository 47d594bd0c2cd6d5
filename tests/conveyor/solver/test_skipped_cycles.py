"""Cycles that repeat themselves are skipped between two samples, and the samples stay the same."""

import numpy as np

from conveyor import Conveyor, parameter_table, sample_runs
from conveyor.solver import record, trajectory
from conveyor.solver.arrivals import CYCLES, SHARE

TOLERANCE = 1e-5
TIMES = np.array([0.53, 1.5, 1.5, 4.0])  # s
# Amplitudes and initial heights of a riding part, of jumping ones with the periods 1 and 2, and of chaos.
MOTIONS = {"riding": (20.0, 0.0), "jumping": (40.0, 3e-4), "doubled": (57.0, 3e-4), "chaos": (80.0, 3e-4)}
ACCELERATION, HEIGHT = np.transpose([*MOTIONS.values()])
PARAMETERS = parameter_table(Conveyor(), acceleration=ACCELERATION, z0=HEIGHT)
times = np.tile(TIMES, (len(MOTIONS), 1))


def test_samples_are_those_of_a_run_that_follows_all_cycles():
    skipped, followed = (sample_runs(PARAMETERS, times, tolerance=TOLERANCE, skip=skip) for skip in (True, False))
    plate = PARAMETERS["acceleration"] / (2.0 * np.pi * PARAMETERS["frequency"])
    # Over all skipped cycles, velocities differ by less than a thousandth of what a calibration can see.
    np.testing.assert_allclose(skipped.vx / plate[:, None], followed.vx / plate[:, None], atol=1e-5)
    mean = [(runs.x[:, 3] - runs.x[:, 0]) / (times[:, 3] - times[:, 0]) / plate for runs in (skipped, followed)]
    np.testing.assert_allclose(*mean, atol=1e-6)
    np.testing.assert_allclose(skipped.peak_force, followed.peak_force, rtol=1e-4)
    np.testing.assert_array_equal(skipped.x[3], followed.x[3])  # chaos never repeats itself


def test_settled_motions_are_not_followed_to_their_end():
    def steps(repetition):
        results = trajectory.integrate(
            PARAMETERS.view(np.float64).reshape(len(MOTIONS), -1), times, tolerance=TOLERANCE, repetition=repetition
        )[1]
        return results[:, record.STEPS] + results[:, record.REPEATS]

    share = dict(zip(MOTIONS, steps((CYCLES, SHARE * TOLERANCE)) / steps((0, 0.0)), strict=True))
    assert share["riding"] < 0.5 and share["jumping"] < 0.5 and share["chaos"] == 1.0
