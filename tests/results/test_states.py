"""States of motion in the sweeps that figures show."""

import pytest

from made import entries

SWEEPS = {table for entry in entries().values() for table in entry["tables"].values() if table.startswith("sweeps/")}


@pytest.mark.parametrize("name", sorted(SWEEPS))
def test_undecided_is_rare(result, name):
    table = result(name)
    assert (table.status == "ok").all()
    assert (table.state == "undecided").mean() < 1e-3
