"""The charts of accuracy: the solver is right where it is chosen, others fail where theory says."""

import numpy as np

SCENES = ("jumping", "riding", "bouncing")


def test_solver_is_right_at_every_tolerance(result):
    for scene in SCENES:
        table = result(f"precision/{scene}")
        own = table[table.method == "event"]
        assert (own.outcome == "ok").all()
        assert (own[own.tolerance <= 1e-9].velocity_error < 1e-7).all()


def test_an_independent_integration_agrees(result):
    """scipy's DOP853 from event to event knows nothing of the solver."""
    for scene in SCENES:
        table = result(f"precision/{scene}")
        peers = table[(table.treatment == "modes") & (table.outcome == "ok")]
        assert peers.velocity_error.min() < 1e-8


def test_solver_needs_fewest_evaluations(result):
    """For every run of another method with four right digits the solver has a better one with fewer evaluations."""
    for scene in SCENES:
        # A mean velocity alone may be right by luck, the state at the end with it hardly.
        table = result(f"precision/{scene}").assign(
            error=lambda rows: rows[["velocity_error", "state_error"]].max(axis=1)
        )
        own = table[table.method == "event"]
        others = table[(table.method != "event") & (table.outcome == "ok") & (table.error < 1e-4)]
        for other in others.itertuples():
            assert ((own.evaluations < other.evaluations) & (own.error <= max(other.error, 1e-12))).any(), other


def test_failures_are_told_whatever_the_methods_report(result):
    """Euler's largest step leaves the right state; a part that falls through the plate has a finite velocity."""
    for scene in SCENES:
        table = result(f"precision/{scene}")
        largest = table[(table.method == "euler") & (table.step == table.step.max())]
        assert (largest.outcome != "ok").all()
        through = table[table.outcome == "through the plate"]
        assert through.mean_velocity.notna().all()
        assert (through.state_error > 1.0).all()
    assert len(through)


def test_edges_of_stability_are_those_of_theory(result):
    table = result("stability")
    edges = table[table.panel == "edge"]
    assert np.abs(edges.x / edges.theory - 1.0).max() < 0.2


def test_fixed_steps_fail_beyond_the_limit_and_hold_within(result):
    table = result("stability")
    for panel in ("stiffness", "damping"):
        rows = table[table.panel == panel]
        beyond, within = rows[rows.x > 1.25 * rows.theory], rows[rows.x < 0.75 * rows.theory]
        assert not (beyond.outcome == "right").any()
        assert not within.outcome.isin(["energy grows", "blow-up"]).any()


def test_solver_holds_in_hard_cases(result):
    table = result("stability")
    assert (table[table.panel.str.startswith("hard")].outcome == "right").all()


def test_euler_chatters_where_the_solver_sticks(result):
    rows = result("stability").query("panel == 'chatter'")
    slip = rows[rows.method == "euler"]
    assert (slip.y > 0.3 * slip.x).all()
    assert (rows[rows.method == "event"].y < 1e-12).all()


def test_choices_cannot_be_told_from_the_full_model(result):
    table = result("scene_budget")
    assert table.groupby("sweep").chosen.sum().eq(1).all()
    assert not (table.chosen & table.visible).any()


def test_no_invisible_variant_costs_less_than_a_third(result):
    """Wall times are noisy; a factor of three is not noise."""
    table = result("scene_budget")
    chosen = table[table.chosen].set_index("sweep").seconds
    table = table[(table.variant == "vertical") | (table.velocities_known > 0.0)]  # nothing is known of chaos
    cheaper = table[~table.visible & (table.seconds < table.sweep.map(chosen) / 3.0)]
    assert cheaper.empty, cheaper
