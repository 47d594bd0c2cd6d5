"""The stroboscopic map to second order: against the linearisation it must contain, and differences of it."""

import numpy as np
import pytest

from conveyor.analysis import second_derivatives, stroboscopic_map
from conveyor.analysis.dimensionless_groups import Groups, packed
from conveyor.solver.model import TENSION_MODES
from conveyor.solver.trajectory import OK

TOLERANCE = 1e-14
# Γ, (x, y): an impact and a long contact; contact, flight and impact; contact from begin to end.
MOTIONS = [(0.9, (-2.0, 0.5)), (1.2, (0.02, 0.3)), (0.5, (0.06, 0.0))]
# Of the damping, like the paper's; of the stiffness, so that the penetration at rest stays about the same.
DAMPING, REST = 1.36, 0.06


def packed_of(values, tension):
    _, _, amplitude, damping, stiffness, exponent = values
    return packed(Groups(amplitude, damping, stiffness, exponent, TENSION_MODES.index(tension)))


def velocity(values):
    x, y, _, damping, *_ = values
    return np.array([x, y - damping * max(x, 0.0)])


def linearised(values, tension):
    """(x, y) after a cycle and its derivatives by (x, y), from the module that knows no others."""
    state = velocity(values)
    status, matrices, _ = stroboscopic_map.monodromy(packed_of(values, tension), TOLERANCE, state, 1, 0.0)
    assert status == OK
    return np.array([state[0], state[1] + values[3] * max(state[0], 0.0)]), matrices[0]


def expanded(values, tension, count=second_derivatives.QUANTITIES):
    found = second_derivatives.cycles(packed_of(values, tension), TOLERANCE, velocity(values), 1, count)
    status, first, second, _, _ = found
    assert status == OK
    return first[0], second[0]


@pytest.mark.parametrize("tension", ["allow", "clip"])
@pytest.mark.parametrize("exponent", [1.0, 1.25, 1.5, 2.0])
@pytest.mark.parametrize("motion", MOTIONS)
def test_derivatives_are_limits_of_differences(motion, exponent, tension):
    amplitude, (x, y) = motion
    values = np.array([x, y, amplitude, DAMPING, REST**-exponent, exponent])
    first, second = expanded(values, tension)
    _, matrix = linearised(values, tension)
    assert first[:, :2] == pytest.approx(matrix, rel=1e-9, abs=1e-9 * np.abs(matrix).max())
    for quantity in range(second_derivatives.QUANTITIES):
        step = 1e-4 if quantity == second_derivatives.EXPONENT else 3e-6 * max(abs(values[quantity]), 0.1)

        def ahead(part, quantity=quantity, step=step):
            changed = values.copy()
            changed[quantity] += part * step
            return linearised(changed, tension)

        ends = [ahead(part) for part in (1.0, -1.0, 2.0, -2.0)]
        for of, exact in ((0, first[:, quantity]), (1, second[:, :, quantity])):
            plus, minus, far_plus, far_minus = (end[of] for end in ends)
            difference = (8.0 * (plus - minus) - (far_plus - far_minus)) / (12.0 * step)
            scale = max(np.abs(difference).max(), 1e-2 * np.abs(first).max())
            assert np.abs(exact - difference).max() < 1e-6 * scale


def test_those_by_the_exponent_may_be_left_out():
    values = np.array([-2.0, 0.5, 0.9, DAMPING, REST**-1.5, 1.5])
    whole, part = expanded(values, "allow"), expanded(values, "allow", second_derivatives.EXPONENT)
    assert part[0] == pytest.approx(whole[0][..., :-1], rel=1e-10)
    assert part[1] == pytest.approx(whole[1][..., :-1], rel=1e-10)
