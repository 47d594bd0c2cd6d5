"""Errors in the sections of the floor study."""

from project import assert_reported


def test_an_unknown_table_of_a_reason_is_reported():
    message = "scene_budget.reasons.critical/egde = 'critical/egde' is unknown; did you mean critical/edge?"
    assert_reported({"scene_budget": {"reasons": {"critical/egde": "none"}}}, message)
