"""All random points: each ends with a status, none is NaN, none lies deeper in the plate than energy can press it."""

from conveyor.sweep import COLUMNS, STATUS


def test_every_point_ends_with_a_status(result):
    table = result("random_points")
    assert len(table) == table.attrs["count"]
    assert set(table.status) <= set(STATUS)
    assert (table.status == "ok").all(), table.status.value_counts()


def test_no_result_is_missing(result):
    table = result("random_points")
    assert table[[*COLUMNS, "max_depth"]].notna().all(axis=None)


def test_no_part_falls_through_the_plate(result):
    table = result("random_points")
    assert (table.max_depth <= table.allowed_depth).all()
