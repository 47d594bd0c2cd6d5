"""How far estimates of exponents and dimensions can be trusted."""

import numpy as np
import pytest


def test_the_paper_s_exponent_of_an_orbit_has_the_wrong_sign(result):
    """A shift of the phase stays a small shift in time on a settled orbit; with Euler it grows, however small it is."""
    table = result("stability_estimates")
    rows = table[(table.panel == "perturbation") & (table.case == "orbit_phase") & (table.epsilon < 1e-6)]
    by_euler, converged = (rows[rows.estimator == method].value for method in ("euler", "event"))
    assert len(by_euler) == len(converged) > 0
    assert (by_euler > 0.0).all()
    assert (converged < 0.0).all()


def test_fixed_steps_lock_the_impacts_of_fig_22(result):
    """The mechanism that the texts name: impacts that should move by the time shift do not, and differences add up."""
    table = result("moved_impacts")
    rows = table[(table.epsilon == table.epsilon.min()) & (table.time == table.time.max())]
    by_euler, converged = (rows[rows.method == method] for method in ("euler", "event"))
    assert len(by_euler) >= 8
    assert (by_euler.moved == 0).all()
    assert (by_euler.difference > by_euler.epsilon).all()
    assert (converged.moved == converged.impacts).all()
    np.testing.assert_allclose(converged.mean_shift, 1.0, atol=1e-3)
    assert (converged.difference < 0.1 * converged.epsilon).all()


def test_impacts_move_if_the_time_shift_is_several_steps(result):
    table = result("moved_impacts").query("method == 'euler' and time_shift > 5.0 * step")
    ends = table[table.time == table.time.max()]
    assert len(ends)
    assert (ends.moved >= 0.95 * ends.impacts).all()
    assert (ends.difference < 0.1 * ends.epsilon).all()


def test_the_paper_s_exponent_of_chaos_depends_on_the_perturbation(result):
    """Soon the distance of the pair is as large as the signal: log(size/ε) over time, for any motion.

    The mean of 1/t over the last quarter of the run is the slope over -log ε.
    """
    table = result("stability_estimates")
    rows = table[(table.case == "chaos_phase") & (table.estimator == "event")]
    late = rows[(rows.panel == "time") & (rows.duration >= 1.0)]
    assert len(late)
    assert (late.value < late.truth).all()
    assert (late.value < late.bound).all()
    saturated = rows[(rows.panel == "perturbation") & rows.epsilon.between(1e-12, 1e-4)]
    assert len(saturated) >= 3
    slope = np.polyfit(-np.log(saturated.epsilon), saturated.value, 1)[0]
    duration = saturated.duration.iloc[0]
    assert slope == pytest.approx(np.log(1.0 / 0.75) / (0.25 * duration), rel=0.05)


def test_dimensions_of_known_sets(result):
    """The intervals contain the true dimension; box counting as in the paper misses it, more so with fewer points."""
    table = result("stability_estimates").query("panel == 'known set'")
    own = table[(table.estimator != "boxes, as in the paper") & table.value.notna()]
    off = (own.value - own.truth).abs()
    assert len(off) >= 8
    assert (off < own.error).mean() >= 0.9  # intervals of 95 %
    assert (off < 2.0 * own.error).all()
    paper = table[table.estimator == "boxes, as in the paper"]
    few, many = (paper[paper.samples == count] for count in (paper.samples.min(), paper.samples.max()))
    assert (few.value - few.truth).abs().sum() > 2.0 * (many.value - many.truth).abs().sum()
    assert not ((paper.value - paper.truth).abs() < paper.error).all()


def test_the_paper_s_boxes_take_a_transient_for_the_orbit(result):
    table = result("stability_estimates")
    boxes = table[(table.panel == "run time") & (table.case == "second")]
    assert len(boxes)
    assert (boxes.value > 1.0 + boxes.error).all()
    settled = table[(table.panel == "samples") & (table.case == "second") & (table.estimator == "boxes")]
    last = settled.iloc[-1]
    assert abs(last.value - 1.0) < last.error
