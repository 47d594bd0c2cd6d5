"""Starts that one thread follows in a second: all methods the same ones, and to the same velocities."""

import pandas as pd
import pytest
from matplotlib.figure import Figure

from accuracy import throughput
from conveyor.methods import heyoka_batch, heyoka_peer
from figures.plots import scaling as chart
from pipeline import grid

MAP = {
    "axes": {"psi0": {"start": 0.0, "stop": 4.5, "num": 4}, "z0": [1.0e-4, 3.0e-4]},
    "model": {"acceleration": 35.0},
}
SETTINGS = {
    "map": MAP,
    "duration": 0.1,
    "tolerance": 1.0e-10,
    "step": 2.0e-6,
    "peers": {"DOP853": 1.0e-10, "heyoka": 1.0e-10},
    "batch": 3,
    "max_evaluations": 100_000,
    "repeats": 1,
    "seconds": 0.01,
}


@pytest.fixture(scope="module")
def table():
    found = pd.DataFrame(throughput.make(SETTINGS)).set_index("treatment")
    found.attrs = SETTINGS
    return found


def test_all_follow_the_same_starts_to_the_same_velocities(table):
    assert set(table.reset_index()) == {field.name for field in throughput.TABLES["throughput"]}
    assert (table.starts == 8).all()
    assert (table.failed[table.outcome == "ok"] == 0).all()
    assert (table.seconds[table.outcome == "ok"] > 0.0).all()
    errors = table.set_index("method", append=True).velocity_error
    assert errors["exact", "event"] < 1e-8
    assert errors["modes", "DOP853"] < 1e-6
    # First order: not right, but no other motion.
    assert 1e-8 < errors["fixed step", "euler"] < 0.05


def test_a_peer_that_is_not_installed_has_no_time(table):
    rows = table[table.method == "heyoka"]
    assert rows.index.tolist() == ["modes", "modes, in batches of 3"]
    assert (rows.outcome == ("ok" if heyoka_peer.installed() else "not installed")).all()
    assert (rows.seconds.isna() != heyoka_peer.installed()).all()
    assert (rows.failed == (0 if heyoka_peer.installed() else 8)).all()


@pytest.mark.skipif(not heyoka_peer.installed(), reason="heyoka is not installed")
def test_heyoka_follows_each_start_of_a_batch_as_it_follows_it_alone():
    """Jumps, micro-bounces, sliding both ways and sticking; the last of three batches is filled up."""
    _, rows = grid.product({**MAP["axes"], "z0": [0.0, 3.0e-4]}, {"acceleration": 47.0})
    together = heyoka_batch.mean_velocities(rows, 0.1, 1e-12, 3, 100_000)
    alone = throughput.one_by_one(rows, "heyoka", 0.1, 1e-12, 100_000)
    assert together == pytest.approx(alone, rel=1e-10)


@pytest.mark.skipif(not heyoka_peer.installed(), reason="heyoka is not installed")
def test_what_heyoka_cannot_follow_in_a_batch_is_refused():
    _, rows = grid.product({"exponent": [1.0, 1.5]}, MAP["model"])
    with pytest.raises(ValueError, match="one exponent"):
        heyoka_batch.mean_velocities(rows, 0.1, 1e-10, 2, 1000)


@pytest.mark.parametrize("name", ["DOP853", "heyoka"])
def test_starts_that_are_given_up_are_counted(name):
    some = SETTINGS | {"peers": {name: 1.0e-10}, "max_evaluations": 100}
    rows = pd.DataFrame(throughput.make(some)).set_index("method").loc[[name]]
    assert (rows.failed == 8).all()
    assert rows.velocity_error.isna().all()


def test_bars_are_those_of_what_was_followed(table):
    axes = Figure().subplots()
    chart.beside_peers(axes, table.reset_index().assign(outcome=["ok", "ok", "ok", *["not installed"] * 2]))
    widths = sorted(bar.get_width() for bar in axes.patches)
    shown = table[:3]
    assert widths == pytest.approx(sorted(shown.starts / shown.seconds))


def test_each_row_has_a_bar_of_its_own(table):
    axes = Figure().subplots()
    chart.beside_peers(axes, table.reset_index().assign(outcome="ok", seconds=1.0))
    names = [label.get_text() for label in axes.get_yticklabels()]
    assert names == ["heyoka,\nin batches of 3", "heyoka", "DOP853", "explicit Euler", "this solver"]
