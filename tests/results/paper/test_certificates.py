"""Certificates of orbits: order of the bounds, agreement with floating point, and the theorems of the page."""

import numpy as np

from conveyor_pipeline.paper.claims.about_proofs import stable_motions
from conveyor_pipeline.paper.orbits.certified import CLOSENESS

BOUNDED = ("delta", "v", "impact_phase", "impact_speed", "duration", "contact_time", "trace", "determinant")


def test_orbits_are_proved(result):
    """Nearly all are proved; each of the rest has a reason."""
    table = result("orbits/certificates")
    assert table.contained.mean() > 0.95
    assert (table.reason.notna() == ~table.contained).all()
    assert (table[table.contained].distance < CLOSENESS).all()
    assert (table[~table.contained].stability == "open").all()


def test_bounds_are_in_order_and_narrow(result):
    table = result("orbits/certificates")
    held = table[table.contained]
    for name in BOUNDED:
        low, high = (held[f"{name}_{end}"].dropna() for end in ("low", "high"))
        assert (low <= high).all(), name
        assert (high - low <= 1e-9 * np.maximum(1.0, np.abs(low))).all(), name
    assert (held.half_width < 1e-12).all()


def test_proved_orbits_agree_with_floating_point(result):
    """States to the round-off of long unstable orbits, stability everywhere, and a period of whole cycles."""
    table = result("orbits/certificates")
    held = table[table.contained]
    assert np.abs(held.stored_delta - held.delta_low).max() < 1e-10
    assert np.abs(held.stored_v - held.v_low).max() < 1e-7
    frequency = table.attrs["model"]["frequency"]
    assert np.abs(held.duration_low * frequency - held.period).max() < 1e-12
    branches = result("orbits/branches")
    # A stored branch that is stable on both sides of an amplitude has an orbit there that is proved stable.
    for acceleration, rows in held.groupby("acceleration"):
        near = branches[(branches.acceleration - acceleration).abs() < 0.2]
        for branch, points in near.groupby("branch"):
            if points.stable.all() and points.acceleration.min() < acceleration < points.acceleration.max():
                assert branch in set(rows[rows.stability == "stable"].branch), acceleration


def test_two_stable_motions_coexist(result):
    counts = stable_motions(result("orbits/certificates"))
    for acceleration in (30.0, 35.0, 40.0, 45.0):
        assert counts.get(acceleration, 0) >= 2


def test_bifurcations_are_bracketed(result):
    table = result("orbits/certified_bifurcations")
    assert table.proved.all()
    assert (table.acceleration_low < table.acceleration_high).all()
    assert (table.acceleration_high - table.acceleration_low < 1e-6).all()
    assert ((table.acceleration_low - table.stored_acceleration).abs() < 1e-6).all()
    # The test function provably has different signs at both ends.
    assert (np.sign(table.test_begin_low) == np.sign(table.test_begin_high)).all()
    assert (np.sign(table.test_end_low) == np.sign(table.test_end_high)).all()
    assert (table.test_begin_low * table.test_end_low < 0.0).all()


def test_chaos_is_proved_where_the_paper_shows_it(result):
    table = result("orbits/certified_chaos").set_index("acceleration")
    assert table.loc[80.0].proved
    assert table.loc[80.0].entropy > 0.1
    assert table[~table.proved].reason.notna().all()


def test_an_impact_costs_less_than_a_second(result):
    table = result("orbits/certificate_times")
    rows = table[(table.kind == "certificates") & (table.impacts > 0)]
    assert (rows.seconds / rows.impacts).median() < 1.0
