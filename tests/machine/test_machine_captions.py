"""Captions of the floor machine."""

import numpy as np
import pandas as pd
from filled_captions import caption
from project import si_config

from conveyor_pipeline.machine.operating.body_limits import MOTIONS


def test_grey_parts_of_the_map_of_tracks_are_explained():
    table = pd.DataFrame({"inclination": [0.1, 0.2], "state": "first", "mean_velocity": [0.1, np.nan]})
    table.attrs |= {"acceleration": 40.0, "starts": 16}
    climbs = caption("track", track=table.assign(status="ok"))
    assert "rises by 5.7°" in climbs and "grey" not in climbs
    assert "too steep" in caption("track", track=table.assign(status=["ok", "slides away"]))
    missing = caption("track", track=table.assign(status=["ok", "no initial condition leads to the state"]))
    assert "Where the map of the first state is grey, none of 16 random initial conditions leads to it." in missing
    assert "too steep" not in missing
    other = table.assign(state="second", mean_velocity=np.nan, status="no initial condition leads to the state")
    both = pd.concat([table.assign(status="ok"), other])
    absent = "On none of these tracks does one of 16 random initial conditions lead to the second state."
    assert absent in caption("track", track=both)


def test_the_operating_chart_says_how_many_amplitudes_a_limit_leaves_open():
    rows = {"acceleration": [30.0, 30.0, 40.0, 50.0], "vertical": 1.0, "state": "first", "starts": 4, "share": 1.0}
    rows |= {"stderr": 0.0, "mean_velocity": [0.1, np.nan, 0.1, np.nan], "status": ["ok", "state not decided"] * 2}
    shares = pd.DataFrame(rows)
    shares.attrs = {"starts": 4, "resolution": 0.005, "height": [0.0, 1e-3], "vz0": [-0.2, 0.2]}
    shares.attrs["psi0"] = [0.0, 6.28]
    none = pd.DataFrame()
    for name, tables in (("basin_stability", {}), ("operating", {"regimes": none, "advice": none})):
        text = caption(name, shares=shares, **tables)
        assert "At 2 of 3 amplitudes, the search for a state or a mean velocity ended before it was known." in text
        assert "``solver.settling``" in text
        slides = shares.assign(status=["ok", "slides away"] * 2)
        assert "ended" not in caption(name, shares=slides, **tables)


def test_an_empty_map_of_tracks_is_explained():
    table = pd.DataFrame({"inclination": [0.1, 0.2], "state": "first", "mean_velocity": np.nan})
    table.attrs |= {"acceleration": 40.0, "starts": 16}
    none = "no initial condition leads to the state"
    text = caption("track", track=table.assign(status=none))
    assert "On these tracks, none of 16 random initial conditions leads to a periodic motion." in text
    assert "On the remaining tracks" in caption("track", track=table.assign(status=[none, "slides away"]))
    text = caption("track", track=table.assign(status="slides away"))
    assert "initial conditions" not in text and "grey" not in text


def test_a_search_that_ended_early_does_not_rule_out_that_parts_climb():
    table = pd.DataFrame({"inclination": [0.1, 0.2, 0.3, 0.4], "state": "first", "mean_velocity": -0.1})
    table.attrs |= {"acceleration": 40.0, "starts": 16}
    assert "Parts climb on none of these tracks." in caption("track", track=table.assign(status="ok"))
    text = caption("track", track=table.assign(status=["ok", "ok", "ok", "not all initial conditions settled"]))
    assert "At 25 % of the inclinations, the search ended before all initial conditions had settled." in text
    assert "solver.settling" in text
    assert "No state that was found climbs." in text and "Parts climb on none" not in text


def test_the_largest_share_of_parts_that_move_back_is_named_although_runs_failed_at_one_amplitude():
    table = pd.DataFrame({"acceleration": [30.0, 60.0, 70.0], "population": "varied", "back": [0.0, 0.2, np.nan]})
    table.attrs = {"spread": {}, "starts": 64, "length": 0.5, "longest": 20.0}
    lengths = pd.DataFrame({"regime": [], "acceleration": [], "spread": [], "predicted": []})
    tables = {"lengths": lengths, "drift": pd.DataFrame({"status": []}), "advice": pd.DataFrame()}
    assert "Some parts move back: at most 20 %, of varied parts at 60 m/s²." in caption(
        "transit", transit=table, **tables
    )
    still = table.assign(back=0.0)
    assert "move back" not in caption("transit", transit=still, **tables)


def test_statements_on_shapes_have_standard_errors_and_are_about_the_papers_conveyor():
    bodies = pd.DataFrame({"acceleration": [21.0]})
    bodies.attrs = {"effort": 1.0, "model": si_config()["model"]}
    rows = [(motion, 21.0, difference, 0.007) for motion in MOTIONS for difference in (-0.01, 0.13)]
    shapes = pd.DataFrame(rows, columns=["motion", "acceleration", "difference", "difference_stderr"])
    text = caption("bodies", bodies=bodies, shapes=shapes)
    assert text.count("found 13 %, standard error 0.7 %, so that it does not hold") == 2
    close = caption("bodies", bodies=bodies, shapes=shapes.assign(difference=0.03))
    assert "found 3 %, standard error 0.7 %, which does not decide it" in close
    assert "found 3 %, standard error 0.7 %)." in close  # the limit for chaos is larger
    assert "with standard errors of 0.7, 0.7 and 0.7 %" in text
    assert "Statements of ours" not in caption("bodies", paper=False, bodies=bodies, shapes=shapes)
