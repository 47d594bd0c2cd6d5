"""What the page of checks says: the solver agrees with published theory."""


def test_all_quantities_agree_with_theory(result):
    table = result("theory")
    assert set(table.kind) == set(table.attrs["accepted"])
    assert (table.difference <= table.accepted).all(), table[table.difference > table.accepted].to_string()
