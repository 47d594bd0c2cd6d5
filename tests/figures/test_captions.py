"""Captions and pages: every number in them comes from a table."""

import numpy as np
import pandas as pd
import pytest
from filled_captions import caption, template_of
from jinja2 import UndefinedError
from project import ROOT, read_config
from prose import typed

from conveyor_pipeline.figures import captions
from conveyor_pipeline.figures.titles import title_of
from conveyor_pipeline.paper.caption_numbers import bifurcation, moved_impacts
from conveyor_pipeline.paper.sensitivity.limits import UNEVEN

CONFIG = read_config()
FIGURES = CONFIG["figures"] | CONFIG["figures_on_request"]


@pytest.mark.parametrize("name", FIGURES)
def test_no_number_of_a_title_or_caption_is_typed(name):
    assert typed(template_of(name)) == []
    assert title_of(name) and "\n" not in title_of(name)


def test_a_missing_number_is_an_error():
    with pytest.raises(UndefinedError, match="speed") as error:
        captions.make("fig01", {}, True, "title\n\nat {{ speed }} m/s")
    assert error.value.__notes__ == [f"in {ROOT / 'scripts/conveyor_pipeline/paper/figures/fig01.rst'}"]
    assert captions.make("fig01", {}, True, "title\n\nno number\n") == "no number\n"


@pytest.mark.parametrize(
    ("orders", "end"),
    [
        ((), ""),
        ((2,), " The plate's motion has a harmonic of the order 2."),
        ((2, 5), " harmonics of the orders 2 and 5."),
    ],
)
def test_captions_name_harmonics_of_the_plate(orders, end):
    table = pd.DataFrame()
    table.attrs = {"model": {"harmonics": [{"order": order} for order in orders]}}
    text = captions.make("fig01", {}, True, "title\n\nSome runs.\n", runs=table)
    assert text.startswith("Some runs.") and text.endswith(f"{end}\n")
    assert ("harmonic" in text) == bool(orders)


def test_plateau_and_exponent_of_fig_22():
    """The estimate at amplitudes with chaos, and the exponent there."""
    acceleration = np.arange(20.0, 91.0)
    chaotic = acceleration >= 63.0
    estimate = pd.DataFrame({"acceleration": acceleration, "lambda": np.where(acceleration >= 59.0, 17.0, -9.0)})
    estimate.attrs = {"epsilon": 1e-8, "step": 5e-7, "duration": 1.0, "model": {"frequency": 50.0}}
    estimate.loc[estimate.acceleration == 70.0, "lambda"] = -1.0
    spectrum = pd.DataFrame(
        {"acceleration": acceleration, "branch": "up", "lambda_1": np.where(chaotic, 36.0, -20.0), "stderr": 1.0}
    )
    states = pd.DataFrame({"acceleration": acceleration, "state": np.where(acceleration >= 61.0, "chaos", "first")})
    states = states.assign(period=np.where(acceleration >= 61.0, 0, 2), longest_flight=acceleration / 200.0)
    euler = estimate.assign(**{"lambda": np.where(acceleration >= 50.0, 1.0, -9.0)})
    text = caption("fig22", converged=estimate, euler=euler, spectrum=spectrum, states=states)
    assert (
        "phases differ by 1e-8 rad, by the paper's method (explicit Euler) and in the converged solution: the mean of"
        in text
    )
    assert "over the last quarter of 1 s" in text
    assert "is positive from 50 m/s² on. Up to 59 m/s², the part settles to the first state, with flights of" in text
    assert "flights of at most 0.29 cycles. The perturbation shifts" in text
    assert "in time by 3e-11 s only. At time steps of 5e-7 s" in text
    assert "is positive only from 59 m/s² on, with exceptions at 1 of 32 amplitudes. On a periodic motion" in text
    assert "stays chaotic is 61" in text
    assert "at 2 of the 31 amplitudes with a positive estimate" in text
    assert "The plateau of 17 1/s" in text
    assert "motion there is 36 1/s." in text


def test_time_shifts_that_never_and_that_always_help():
    ends = pd.DataFrame({"time_shift": [1.0, 2.0, 3.0, 4.0, 5.0], "difference": [2.0, 2.0, 0.5, 2.0, 0.5]})
    ends = ends.assign(step=10.0, epsilon=1.0)
    assert moved_impacts.longest_useless_shift(ends) == 0.2
    assert moved_impacts.shortest_sufficient_shift(ends) == 0.5


def test_chaos_before_the_accumulation_is_mentioned(monkeypatch):
    acceleration = np.arange(55.0, 70.0, 0.5)
    spectrum = pd.concat(
        pd.DataFrame(
            {
                "acceleration": acceleration,
                "branch": branch,
                "lambda_1": np.where((acceleration > 63.0) & (acceleration != 66.0) | early, 20.0, -20.0),
                "stderr": 1.0,
            }
        )
        for branch, early in (("up", (acceleration >= 59.5) & (acceleration <= 61.0)), ("down", False))
    )
    cascade = pd.DataFrame({"accumulation": [np.nan, 62.77]})
    orbits = pd.DataFrame({"cycle": [1, 2, 1, 2]})
    orbits.attrs["max_period"] = 4
    others = {"spectrum": spectrum, "branches": orbits, "bifurcations": pd.DataFrame({"kind": ["fold"]})}
    text = caption("bifurcation", {"longest_period": 2}, cascade=cascade, **others)
    assert "accumulate at 62.77 m/s²." in text
    assert "(increasing amplitude: 59.50 to 61.00 m/s²; decreasing amplitude: nowhere)" in text
    assert f"; {100 * 2 / 14:.0f} % of the amplitudes" in text  # 63.0 and the window at 66.0
    without = caption("bifurcation", {"longest_period": 2}, cascade=cascade[:1], **others)
    assert without.endswith("attractors. No cascade of period doublings was found.")
    monkeypatch.setattr(bifurcation, "MOST_ORBITS", 2)
    ended = caption("bifurcation", {"longest_period": 2}, cascade=cascade[:1], **others)
    assert "The search ended after 2 orbits; within narrower ``orbits.limits``" in ended
    assert "None of these orbits folds" not in ended
    straight = others | {"bifurcations": pd.DataFrame({"kind": ["grazing"]})}
    text = caption("bifurcation", {"longest_period": 2}, cascade=cascade[:1], **straight)
    assert "None of these orbits folds or doubles its period." in text
    none = others | {"branches": orbits[:0], "bifurcations": pd.DataFrame({"kind": []})}
    empty = caption("bifurcation", {"longest_period": 2}, cascade=cascade[:1], **none)
    assert "No initial condition was found to lead to a stable orbit of up to 4 cycles" in empty


def test_a_map_states_its_undecided_share_and_the_key_that_reduces_it():
    table = pd.DataFrame({"state": ["first", "first", "undecided", "second"] * 5})
    text = caption("fig12", paper=False, map=table)
    assert "The search ended before 25 % of the initial conditions had settled (undecided)." in text
    assert text.endswith("``solver.settling`` in the config follows them further.")
    assert "undecided" not in caption("fig12", map=table[:2])
    assert "All initial conditions lead to" not in text
    assert caption("fig12", paper=False, map=table[:2]).endswith("All initial conditions lead to the first state.")
    none = caption("fig12", map=table[:2].assign(state="undecided"))
    assert "lead to" not in none and "before 100 % of the initial conditions" in none


def test_fig_10_without_a_common_amplitude_or_without_a_critical_height():
    columns = {"acceleration": [40.0], "z0": [1e-4], "is_critical": [True], "status": "ok"}
    columns |= {"state_below": "first", "state_above": "second"}
    converged, euler = (pd.DataFrame(columns | {"acceleration": [a]}) for a in (30.0, 40.0))
    converged.attrs = {"scan": {"start": 0.0, "stop": 5e-4, "num": 9}}
    tables = {"converged": converged, "euler": euler, "fit": converged}
    assert "at no common amplitude" in caption("fig10", **tables)
    back = pd.concat([converged, converged.assign(z0=2e-4, is_critical=False, state_above="first")])
    for table, returns in ((converged, False), (back, True), (back.assign(state_above="chaos"), False)):
        assert ("Triangles" in caption("fig10", **tables | {"converged": table})) == returns
    many = back.assign(status="between two heights of the scan")
    assert "known to one step of the scan" in caption("fig10", **tables | {"converged": many})
    open_ = back.assign(state_above="undecided", acceleration=[30.0, 40.0])
    text = caption("fig10", **tables | {"converged": open_})
    assert "At 2 amplitudes, the search ended before the state of motion was known for all heights." in text
    tables |= {"converged": converged[:0], "fit": converged[:0]}
    tables["converged"].attrs = converged.attrs
    text = caption("fig10", paper=False, **tables)
    assert "Up to 0.5 mm, no initial height was found to change the state of motion at any of these amplitudes." in text
    tables["converged"] = converged.assign(is_critical=False)
    tables["converged"].attrs = converged.attrs
    text = caption("fig10", paper=False, **tables)
    assert "Up to 0.5 mm, no initial height was found to end the first state at any of these amplitudes." in text


def test_a_track_that_is_too_steep_is_named():
    """Friction 0.3 stops a part up to 0.29 rad. Static friction holds a part on a steeper track, but stops none."""
    table = pd.DataFrame({"z0": [0.0], "mean_velocity": [-0.3], "state": "first"})
    for inclination, static, steep in ((0.2, None, False), (0.32, None, True), (0.32, 0.4, True), (-0.5, 0.4, True)):
        model = {"friction": 0.3, "inclination": inclination} | ({"static_friction": static} if static else {})
        table.attrs |= {"model": model, "duration": 1.0, "step": 1e-6}
        text = caption("fig03", paper=False, converged=table, euler=table)
        assert ("slides away faster and faster" in text) == steep


def test_states_change_at_a_critical_height_if_the_first_state_ends():
    table = pd.DataFrame({"acceleration": 40.0, "state": ["chaos", "undecided", "second", "chaos"]})
    assert "no critical height" in caption("fig09", converged=table)
    text = caption("fig09", converged=table.assign(state=["first", "undecided"] * 2))
    assert "no critical height is known: the search ended before 50 % of the initial conditions had settled" in text
    assert "The velocity jumps where" in caption("fig09", converged=table.assign(state=["first", "chaos"] * 2))


def test_a_state_that_all_heights_lead_to_is_named():
    table = pd.DataFrame({"state": ["second", "second"], "status": "ok"})
    assert "All initial heights lead to the second state." in caption("fig17", paper=False, converged=table)
    one = table.assign(state="undecided")
    assert "States of motion: undecided." in caption("fig17", paper=False, converged=one)
    several = table.assign(state=["second", "chaos"])
    assert "States of motion: the second state and chaos." in caption("fig17", paper=False, converged=several)


def test_points_that_are_not_found_again_are_counted():
    lost = {
        "kind": "critical_height",
        "parameter": "mass",
        "change": np.nan,
        "elasticity": np.nan,
        "acceleration": 40.0,
    }
    lost["status"] = "not found again beside it"
    changes = pd.DataFrame([lost])
    curves = pd.DataFrame({"parameter": [], "kind": [], "begin": [], "meeting": [], "status": [], "damping_group": []})
    curves.attrs = {"model": {"exponent": 1.5}}
    tables = {"continued": curves, "meetings": curves, "bifurcations": pd.DataFrame({"period": [], "kind": []})}
    assert "No point was found again beside it" in caption("sensitivity", changes=changes, **tables)
    right = pd.DataFrame([lost | {"change": 1e-6, "elasticity": 1.0, "status": "ok"}])
    text = caption("sensitivity", changes=right, **tables)
    assert "one per cent less of the parameter." in " ".join(text.split())
    both = pd.concat([right, changes, changes, changes.assign(status=UNEVEN)])
    text = caption("sensitivity", changes=both, **tables)
    assert "left out: 2 that were not found again, 1 whose two sides differ" in text
    none = changes.assign(kind="critical_amplitude")
    assert "There is no change to show" in caption("sensitivity", changes=none, **tables)
