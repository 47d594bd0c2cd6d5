"""The test of the model against measurements whose distribution is known."""

import numpy as np
import pytest

from conveyor_pipeline.machine.calibration.inference import Data
from conveyor_pipeline.machine.calibration.measurements import Measurement
from conveyor_pipeline.machine.calibration.model_check import compare, differs

SETTINGS = {"noise": 0.02, "replicates": 500}
CONDITIONS, REPEATS, PARTS = 6, 3, 64
OF = np.repeat(np.arange(CONDITIONS), REPEATS)
CENTRES = np.linspace(0.05, 0.3, CONDITIONS)
SPREADS = np.array([0.0, 0.0, 0.1, 0.1, 0.3, 0.3])  # relative: motions that settle, and chaos


def parts_of(random, shape):
    return CENTRES[:, None] * (1.0 + SPREADS[:, None] * random.standard_normal((CONDITIONS, *shape)))


def p_value(seed, change=lambda velocity: velocity):
    """p-value and the shares of the single measurements for parts and measurements of one model."""
    random = np.random.default_rng(seed)
    true = parts_of(random, (REPEATS,)).ravel()
    velocity = change(true * (1.0 + 0.02 * random.standard_normal(true.shape)))
    data = Data([], None, OF, velocity, np.full(len(OF), np.nan), np.full(len(OF), 0.4))
    p, shares, _ = compare(parts_of(random, (2 * PARTS,)), data, SETTINGS, random)
    return p, shares


def test_p_values_of_a_right_model_are_small_as_rarely_as_they_say():
    found = np.array([p_value(seed)[0] for seed in range(60)])
    assert np.mean(found < 0.05) <= 0.12
    assert np.median(found) > 0.3


@pytest.mark.parametrize(
    ("change", "wrong"),
    [
        (lambda velocity: velocity * np.where((OF == 2) | (OF == 3), 1.35, 1.0), "chaotic velocities too high"),
        (lambda velocity: velocity * np.where(OF < 2, 1.07, 1.0), "settled velocities too high"),
        (lambda velocity: velocity * np.where(OF < 2, 1.0 + 0.1 * np.tile([1, -1, 0], CONDITIONS), 1.0), "scattered"),
        (lambda velocity: velocity * np.where(OF > 3, 0.3, 1.0), "widely spread velocities too low"),
    ],
)
def test_p_values_of_a_wrong_model_are_small(change, wrong):
    assert max(p_value(seed, change)[0] for seed in range(5)) < 0.03, wrong


def test_measurements_on_one_side_of_the_band_at_several_amplitudes_are_noticed_although_each_one_is_likely():
    def shifted(velocity):
        wide = SPREADS[OF] == 0.3
        return np.where(wide, CENTRES[OF] * 1.4, velocity)

    p, shares = p_value(3, shifted)
    assert p < 0.03 and shares[SPREADS[OF] == 0.3].min() > 0.01


def test_one_mistake_is_noticed_but_does_not_reject_the_model():
    def mistaken(velocity):
        return np.where(np.arange(len(velocity)) == 4, 0.25, velocity)

    for seed in range(5):
        p, shares = p_value(seed, mistaken)
        assert p > 0.03
        assert shares.argmin() == 4 and shares[4] < 0.01


def test_a_stated_value_of_the_model_is_no_other_condition():
    one = Measurement(2, 40.0, 0.06, None, 1.0, 1.0, {"mass": 1e-3})
    assert not differs(one, {"mass": 1e-3})
    assert differs(one, {"mass": 2e-3})
    assert differs(one._replace(changed={"z0": 0.0}), {"mass": 1e-3})
