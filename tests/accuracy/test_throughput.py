"""Starts that one thread follows in a second: all methods the same ones, and to the same velocities."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from accuracy import throughput
from conveyor.methods import heyoka_peer
from figures.plots import scaling as chart

MAP = {
    "axes": {"psi0": {"start": 0.0, "stop": 4.5, "num": 4}, "z0": [1.0e-4, 3.0e-4]},
    "model": {"acceleration": 35.0},
}
SETTINGS = {
    "duration": 0.1,
    "tolerance": 1.0e-10,
    "step": 2.0e-6,
    "peers": {"DOP853": 1.0e-10, "heyoka": 1.0e-10},
    "max_evaluations": 100_000,
    "repeats": 1,
}


@pytest.fixture(scope="module")
def table():
    found = pd.DataFrame(throughput.make(SETTINGS, MAP)).set_index("method")
    found.attrs = SETTINGS
    return found


def test_all_follow_the_same_starts_to_the_same_velocities(table):
    assert set(table.reset_index()) == {field.name for field in throughput.TABLES["throughput"]}
    assert (table.starts == 8).all()
    assert (table.failed[table.outcome == "ok"] == 0).all()
    assert (table.seconds[table.outcome == "ok"] > 0.0).all()
    assert table.velocity_error["event"] < 1e-8
    assert table.velocity_error["DOP853"] < 1e-6
    # First order: not right, but no other motion.
    assert 1e-8 < table.velocity_error["euler"] < 0.05


def test_a_peer_that_is_not_installed_has_no_time(table):
    row = table.loc["heyoka"]
    assert row.outcome == ("ok" if heyoka_peer.installed() else "not installed")
    assert np.isnan(row.seconds) != heyoka_peer.installed()


def test_starts_that_are_given_up_are_counted():
    some = SETTINGS | {"peers": {"DOP853": 1.0e-10}, "max_evaluations": 100}
    row = pd.DataFrame(throughput.make(some, MAP)).set_index("method").loc["DOP853"]
    assert row.failed == 8
    assert np.isnan(row.velocity_error)


def test_bars_are_those_of_what_was_followed(table):
    axes = Figure().subplots()
    chart.beside_peers(axes, table.reset_index().assign(outcome=["ok", "ok", "ok", "not installed"]))
    widths = sorted(bar.get_width() for bar in axes.patches)
    shown = table[:3]
    assert widths == pytest.approx(sorted(shown.starts / shown.seconds))
