"""The page of checks: the solver agrees with published theory, and maps agree with brute force."""

from conveyor_pipeline.study.accuracy import map_check
from conveyor_pipeline.study.accuracy.theory import ACCEPTED


def test_all_quantities_agree_with_theory(result):
    table = result("theory")
    assert set(table.kind) == set(ACCEPTED)
    assert (table.difference <= table.accepted).all(), table[table.difference > table.accepted].to_string()


def test_labels_of_maps_agree_with_brute_force(result):
    table = result("map_check")
    assert (table.label != table.state).mean() <= map_check.ACCEPTED
    chaos = table[table.state == "chaos"]
    assert (chaos.cycles >= map_check.CYCLES).all()
    assert (chaos.exponent > map_check.SIGNIFICANT * chaos.exponent_error).all()
    assert (table[table.state.isin(["first", "second"])].period > 0).all()
