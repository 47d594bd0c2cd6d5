"""All random points: each ends with a status, none is NaN, none lies deeper in the plate than energy can press it."""

import numpy as np

from conveyor.ensemble import COLUMNS, STATUS
from conveyor.solver.model import FREQUENCY, PARAMETERS

# Contact rates (1/s) times the cycle: beyond that a contact may be too stiff to be followed.
STIFF = 1e4


def rates(table):
    """Steps that the contact's own rates would need in a cycle: d_c/m, and the frequency at the static penetration."""
    static = (table.gravity * table.mass / table.stiffness) ** (1.0 / table.exponent)
    return np.maximum(table.damping / table.mass, np.sqrt(2.0 * table.gravity / static)) / table[PARAMETERS[FREQUENCY]]


def test_every_point_ends_with_a_status(result):
    table = result("random_points")
    assert table.drawn.value_counts().to_dict() == table.attrs["count"]
    assert set(table.status) <= set(STATUS)
    near = table[table.drawn == "around the paper"]
    assert (near.status == "ok").all(), near.status.value_counts()


def test_no_search_gets_lost_within_the_ranges(result):
    assert (result("random_points").status != "impact not found").all()


def test_what_is_given_up_is_too_stiff(result):
    """Or starts so deep in the plate that its spring overflows."""
    table = result("random_points")
    given_up = table[table.status.isin(["contact too stiff", "too many events"])]
    # One in a thousand over the whole ranges.
    assert len(given_up) or table.attrs["count"]["whole ranges"] < 1000
    assert (rates(given_up) > STIFF).all()
    assert (table.status == "ok").mean() > 0.5


def test_no_result_is_missing(result):
    table = result("random_points")
    ok = table[table.status == "ok"]
    assert len(ok)
    assert ok[[*COLUMNS, "max_depth"]].notna().all(axis=None)


def test_no_part_falls_through_the_plate(result):
    """The bound is no blank cheque: half of the parts use at least a quarter of it."""
    ok = result("random_points").query("status == 'ok'")
    assert (ok.max_depth <= ok.allowed_depth * (1.0 + 1e-9)).all()
    deep = ok[ok.max_depth > 0.0]
    assert (deep.max_depth / deep.allowed_depth).median() > 0.25
