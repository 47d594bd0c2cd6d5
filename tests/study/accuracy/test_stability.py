"""Limits of stability: closed forms, and what becomes of a part on either side of them."""

import math

import numpy as np
import pytest

from conveyor.solver.model import Conveyor
from conveyor_pipeline.study.accuracy import closed_forms, stability

MASS = Conveyor().mass


def test_limits_of_a_hardly_damped_contact():
    """d/k, 2/ω and 2√2/ω."""
    stiffness, damping = 1e5, 1e-6
    omega = math.sqrt(stiffness / MASS)
    assert stability.stability_limit("euler", stiffness, damping, MASS) == pytest.approx(damping / stiffness, rel=1e-9)
    assert stability.stability_limit("semi_implicit_euler", stiffness, damping, MASS) * omega == pytest.approx(
        2.0, rel=1e-6
    )
    assert stability.stability_limit("rk4", stiffness, damping, MASS) * omega == pytest.approx(math.sqrt(8.0), rel=1e-3)


def test_a_method_without_a_stability_polynomial_has_no_limit(monkeypatch):
    monkeypatch.setitem(stability.fixed_step.GROWTH, "rk4", None)
    assert math.isnan(stability.stability_limit("rk4", 1e5, 0.3, MASS))


def test_limit_of_an_impact_by_euler_weights_the_stiffness_with_the_speed():
    conveyor, speed = Conveyor(acceleration=0.0), 0.1
    share = (np.arange(200_000) + 0.5) / 200_000
    velocity = np.sqrt(1.0 - share**2.5)
    stiffness = 1.5 * conveyor.stiffness * np.sqrt(share * closed_forms.compression(conveyor, speed))
    wanted = conveyor.damping / ((stiffness * velocity).sum() / velocity.sum())
    assert stability.impact_limit("euler", conveyor, speed) == pytest.approx(wanted, rel=1e-4)


@pytest.mark.parametrize("damping", [0.3, 10.0])
@pytest.mark.parametrize("method", ["euler", "semi_implicit_euler", "rk4"])
def test_a_part_rests_within_the_limit_and_not_beyond(method, damping):
    limit = stability.stability_limit(method, 1e5, damping, MASS)
    assert stability.outcome_at_rest(method, 0.7 * limit, 1e5, damping) == stability.RIGHT
    assert stability.outcome_at_rest(method, 1.3 * limit, 1e5, damping) in (stability.GROWS, stability.BLOWS_UP)


def test_the_solver_is_right_at_rest_and_in_impacts():
    assert stability.outcome_at_rest("event", math.nan, 1e7, 0.3) == stability.RIGHT
    conveyor = Conveyor(acceleration=0.0, gravity=1e-3, damping=0.0)
    assert stability.restitution("event", math.nan, 0.3, conveyor) == pytest.approx(1.0, rel=1e-8)
