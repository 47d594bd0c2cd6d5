"""Curves of bifurcations: every point is a bifurcation, closed forms, and points of codimension two from both sides."""

from types import SimpleNamespace

import numpy as np
import pytest

from conveyor import Conveyor, Start
from conveyor.analysis.bifurcations import bifurcation_curves
from conveyor.analysis.bifurcations.bifurcation_curves import (
    ParameterPath,
    follow_bifurcation_curve,
    follow_grazing_curve,
    normal_form,
)
from conveyor.analysis.bifurcations.bifurcation_points import GRAZING, SIGNS, find_bifurcation, linearise
from conveyor.analysis.bifurcations.newton import newton
from conveyor.analysis.dimensionless_groups import Groups, groups_of
from conveyor.solver.model import pack

GROUPS = groups_of(pack(Conveyor(), Start()))
FOLD, DOUBLING = (-3.41, 1.614, 0.50815), (-6.257, 0.5009, 1.1491)
LIMITS = {"amplitude": (0.1, 5.0), "longest_step": 0.1, "max_points": 400}
ALONG = np.array([1.0, 0.0])


def fixed_point(groups, state, period):
    def system(here):
        cycles = linearise(groups, here, period)
        return cycles.image - here, cycles.matrix - np.eye(2)

    return newton(system, state, converged=1e-10, iterations=30)


@pytest.fixture(scope="module")
def fold_over_damping():
    """The curve up to the cusp and back."""
    point = find_bifurcation("fold", 1, FOLD, GROUPS)
    return follow_bifurcation_curve(point, ParameterPath(1.0, 0.0), reach=(-0.5, np.log(8.0)), **LIMITS)


def test_a_curve_whose_first_step_fails_is_its_first_point():
    point = find_bifurcation("fold", 1, FOLD, GROUPS)
    curve = follow_bifurcation_curve(
        point, ParameterPath(1.0, 0.0), reach=(-0.5, 0.5), **LIMITS | {"longest_step": 0.0}
    )
    assert (len(curve.points), curve.ends, curve.meetings) == (1, ("step", "step"), [])


@pytest.mark.parametrize("kind", ["fold", "period_doubling"])
@pytest.mark.parametrize("path", [ParameterPath(0.0, 1.0), ParameterPath(-1.0, -3.0)])
def test_every_point_of_a_curve_is_a_bifurcation(kind, path):
    point = find_bifurcation(kind, 1, FOLD if kind == "fold" else DOUBLING, GROUPS)
    curve = follow_bifurcation_curve(point, path, reach=(-0.5, 0.5), **LIMITS)
    assert curve.ends == ("limit", "limit")
    assert np.ptp(curve.log_ratios) > 1.0
    for one, part in zip(curve.points[::4], curve.log_ratios[::4], strict=True):
        cycle = linearise(one.groups, one.unknown[:2], 1)
        assert cycle.image == pytest.approx(one.unknown[:2], abs=1e-9)
        multipliers = np.linalg.eigvals(cycle.matrix)
        assert np.abs(multipliers - SIGNS[kind]).min() < 1e-7
        assert one.groups.damping == pytest.approx(GROUPS.damping * np.exp(path.damping * part))
        assert one.groups.stiffness == pytest.approx(GROUPS.stiffness * np.exp(path.stiffness * part))


def test_the_curve_turns_back_at_its_cusp(fold_over_damping):
    """There it is the largest damping of the curve, which begins and ends at smaller ones, and two folds meet."""
    (cusp,) = [one for one in fold_over_damping.meetings if one.kind == "cusp"]
    assert cusp.status == "ok"
    assert fold_over_damping.log_ratios.max() <= cusp.log_ratio + 1e-9
    assert cusp.log_ratio == pytest.approx(fold_over_damping.log_ratios.max(), abs=1e-3)
    at_cusp, _ = normal_form(cusp.point, ALONG)
    assert abs(at_cusp) < 1e-6
    assert fold_over_damping.normal_forms[0] * fold_over_damping.normal_forms[-1] < 0.0


def test_a_grazing_lies_between_the_points_where_the_impact_exists_and_where_not(fold_over_damping):
    """The touching orbit is a fold, too, and every point on one side of it has one impact more."""
    (grazing,) = (meeting for meeting in fold_over_damping.meetings if meeting.kind == GRAZING)
    assert grazing.status == "ok"
    phase, amplitude = grazing.point.unknown
    touch = linearise(grazing.point.groups, np.zeros(2), 1, phase)
    assert np.abs(touch.image).max() < 1e-7
    assert abs(1.0 - np.trace(touch.matrix) + np.linalg.det(touch.matrix)) < 1e-6
    impacts = np.array([linearise(point.groups, point.unknown[:2], 1).impacts for point in fold_over_damping.points])
    (before,) = np.flatnonzero(np.diff(impacts))
    between = slice(before, before + 2)
    amplitudes = [point.groups.amplitude for point in fold_over_damping.points[between]]
    assert min(amplitudes) < amplitude < max(amplitudes)
    ratios = fold_over_damping.log_ratios[between]
    assert ratios.min() < grazing.log_ratio < ratios.max()


def test_normal_form_of_a_supercritical_doubling():
    """The doubled orbit of the paper's conveyor is stable: its cubic coefficient is positive."""
    value, right = normal_form(find_bifurcation("period_doubling", 1, DOUBLING, GROUPS), ALONG)
    assert value > 0.0
    assert np.linalg.norm(right) == pytest.approx(1.0)


def test_normal_form_of_a_fold_turns_with_its_eigenvector():
    point = find_bifurcation("fold", 1, FOLD, GROUPS)
    value, right = normal_form(point, ALONG)
    other, turned = normal_form(point, -ALONG)
    assert turned == pytest.approx(-right)
    assert other == pytest.approx(-value)


def test_lift_off_of_a_linear_contact_over_damping_and_stiffness():
    """Γ = |K - 1 + iD|/K."""
    damping, stiffness = 1.3, 70.0
    response = stiffness - 1.0 + 1j * damping
    groups = Groups(abs(response) / stiffness, damping, stiffness, 1.0, 0)
    phase = (np.pi + np.angle(response)) % (2.0 * np.pi)
    point = find_bifurcation(GRAZING, 1, (phase, groups.amplitude), groups)
    curve = follow_grazing_curve(point, ParameterPath(1.0, -1.0), (0.1, 5.0), (-2.0, 2.0), step=0.1)
    assert curve.ends == ("limit", "limit")
    for one in curve.points:
        exact = abs(one.groups.stiffness - 1.0 + 1j * one.groups.damping) / one.groups.stiffness
        assert one.groups.amplitude == pytest.approx(exact, rel=1e-7)


def test_a_curve_says_why_it_ends():
    point = find_bifurcation("fold", 1, FOLD, GROUPS)
    short = follow_bifurcation_curve(
        point, ParameterPath(1.0, 0.0), reach=(-3.0, 3.0), amplitude=(0.1, 5.0), longest_step=0.02, max_points=10
    )
    assert short.ends == ("length", "length")
    low = follow_bifurcation_curve(
        point, ParameterPath(1.0, 0.0), reach=(-3.0, 3.0), amplitude=(0.4, 0.6), longest_step=0.1, max_points=100
    )
    assert low.ends == ("limit", "limit")
    assert 0.3 < low.points[0].groups.amplitude <= 0.4


def test_normal_form_gives_the_distance_of_the_doubled_orbit():
    """With the multiplier -(1 + μ) and the cubic coefficient c it is √(μ/c) along the eigenvector, for small μ."""
    point = find_bifurcation("period_doubling", 1, DOUBLING, GROUPS)
    coefficient, right = normal_form(point, ALONG)
    groups = point.groups._replace(amplitude=point.groups.amplitude * (1.0 + 1e-5))
    single = fixed_point(groups, point.unknown[:2], 1)
    multiplier = np.linalg.eigvals(linearise(groups, single, 1).matrix).real.min()
    distance = np.sqrt((-1.0 - multiplier) / coefficient)
    doubled = fixed_point(groups, single + distance * right, 2)
    assert abs((doubled - single) @ right) == pytest.approx(distance, rel=0.03)


@pytest.mark.parametrize(("test", "status"), [(lambda u: u[3] - 0.3, "ok"), (lambda u: np.sign(u[3] - 0.3), "jump")])
def test_a_test_function_that_jumps_is_not_zero(test, status):
    """Beside a grazing the coefficient of the normal form may change its sign without a zero."""
    straight = SimpleNamespace(kind="fold", correct=lambda guess, _: guess, point=lambda unknown: unknown)
    found = bifurcation_curves._degenerate(straight, np.zeros(4), np.array([0.0, 0.0, 0.0, 1.0]), test)
    assert found.log_ratio == pytest.approx(0.3, abs=1e-7)
    assert status in found.status
