"""The page and the overlay: what they say first, and when there is no overlay."""

import math

import pandas as pd
import pytest
import yaml
from project import ROOT

from conveyor_pipeline.common.rule_log import JobError
from conveyor_pipeline.machine.calibration import overlay, page
from conveyor_pipeline.machine.calibration.inference import DETERMINED, NOT_CONVERGED, NOT_DETERMINED, OPEN

SETTINGS = {
    "measurements": "mine.csv",
    "static_friction": 0.3,
    "noise": 0.02,
    "parameters": ["friction", "damping", "stiffness"],
    "model": {"inclination": 0.0, "phase_shift": 0.0},
    "effort": 1.0,
}


def tables(
    *,
    explained=True,
    alternative=False,
    converged=True,
    misfits=0,
    changed=0,
    found=100.0,
    effort=1.0,
    narrowing=0.1,
    status=(DETERMINED, OPEN, NOT_DETERMINED),
):
    status = status if converged else [NOT_CONVERGED] * 3
    parameters = pd.DataFrame(
        {
            "parameter": ["friction", "damping", "stiffness"],
            "unit": ["1", "N s/m", "N/m^p"],
            "best": [0.24, 0.7, 4e5],
            "best_error": [0.002, 0.03, 5e4],
            "low_error": 0.01,
            "high_error": 0.01,
            "searches": 4,
            "low": [0.23, 0.6, 1e5],
            "high": [0.25, 10.0, 9e5],
            "range_low": [0.03, 0.02, 1e4],
            "range_high": [1.2, 10.0, 1e9],
            "status": status,
            "effective": found,
        }
    )
    if not converged:
        parameters = parameters.assign(
            **dict.fromkeys(("best", "best_error", "low", "low_error", "high", "high_error"), math.nan)
        )
    fit = pd.DataFrame({"line": [2, 3, 4, 5], "acceleration": [30.0, 40.0, 50.0, 60.0], "velocity": 0.05})
    fit = fit.assign(low=0.01, high=0.02, p_row=[0.5, 0.001, 0.002, 0.4], p_value=0.3 if explained else 5e-4)
    fit = fit.assign(changed=[False] * (4 - changed) + [True] * changed)
    fit = fit.assign(fits=[True] * (4 - misfits) + [False] * misfits, explained=explained and not alternative)
    prediction = pd.DataFrame({"acceleration": [30.0, 60.0], "low": 0.01, "median": 0.02, "high": [0.03, 0.04]})
    alternatives = pd.DataFrame({"parameter": ["inclination", "phase_shift"], "unit": "rad", "value": [0.06, 0.3]})
    alternatives = alternatives.assign(log_bayes_factor=[16.1 if alternative else -2.0, -3.0], effective=50.0)
    alternatives = alternatives.assign(preferred=[alternative, False])
    next_ = pd.DataFrame({"acceleration": [30.0, 45.0], "narrowing": [0.0, narrowing]})
    next_ = next_.assign(**{f"narrowing_{name}": [0.0, narrowing] for name in parameters.parameter})
    parameters.attrs = SETTINGS | {"effort": effort}
    if not converged:
        nothing = dict.fromkeys(("low", "high", "p_row", "p_value", "fits", "explained"))
        fit = fit.assign(**nothing)
        alternatives, prediction, next_ = alternatives.head(0), prediction.head(0), next_.head(0)
    known = {"parameters": parameters, "fit": fit, "alternatives": alternatives}
    return known | {"prediction": prediction, "next": next_}


def whole_page(**options):
    template = (ROOT / "workflow/rules/machine/calibration.md").read_text(encoding="utf-8")
    text = "# Synthetic, not measured\nacceleration,velocity\n"
    return page.make(template, **tables(**options), measurements=text, prefix="mine")


def first_screen(**options):
    return whole_page(**options).partition("## Parameters")[0]


def test_the_page_begins_with_what_was_found_how_sure_it_is_and_what_to_do():
    text = first_screen()
    assert "**The model explains the 4 measured velocities.**" in text
    assert "friction coefficient **0.24**, contact damping **0.7 N s/m**, contact stiffness **4e5 N/m^p**" in text
    assert "the friction coefficient lies between 0.23 and 0.25" in text
    assert "the contact damping is at least 0.6 N s/m, and may be much larger" in text
    assert "the measurements say nothing about the contact stiffness" in text
    assert "measure one more velocity at **45 m/s²**" in text and "10 % on average" in text
    assert "snakemake results/mine/calibrated.yaml" in text
    assert text.endswith('mine.csv begins with the comment "Synthetic, not measured".\n\n')
    assert "the contact damping and the contact stiffness reach the end of the searched range" in text


def test_the_page_says_for_which_conditions_the_predicted_velocities_hold():
    stated = "These are means over 1 s, after 1 s on the track, for random initial conditions."
    assert stated in whole_page() and "other conditions" not in whole_page()
    text = whole_page(changed=2)
    assert stated in text and "2 lines of mine.csv were measured under other conditions" in text


def test_factors_below_a_thousand_have_no_exponent():
    assert [page.power_of_ten(one) for one in (2.0, 2.9, -1.5, -2.5, 5.2)] == ["100", "790", "0.032", "0.0032", "10^5"]


def test_the_page_asks_for_no_check_if_all_parameters_are_determined():
    assert "end of the searched range" not in first_screen(status=[DETERMINED] * 3)


def test_a_model_that_is_wrong_is_called_so_first():
    text = first_screen(explained=False, misfits=2)
    assert text.startswith("# Calibration\n\n**The model does not explain the measurements.**")
    assert "2 of the 4 measured velocities are very unlikely" in text
    assert "phase shift" in text and "units" in text.lower() and "inclination" in text
    assert "| 4 | 50 |" in text and "| 2 | 30 |" not in text
    assert "calibrated.yaml --configfile" not in text


def test_a_parameter_that_explains_much_more_rejects_the_model_and_is_named_with_its_value():
    text = first_screen(alternative=True)
    assert text.startswith("# Calibration\n\n**The model does not explain the measurements.**")
    assert "`inclination` = **0.06 rad** (3.4°)" in text and "10^7 times as probable" in text
    assert "`model: {inclination: 0.06}`" in text and "[friction, damping, stiffness, inclination]" in text
    assert "very unlikely" not in text and "phase_shift` =" not in text


def test_a_search_that_has_not_converged_says_only_that():
    """No verdict, no number of a parameter, no error, and no advice on effort."""
    text = whole_page(converged=False, found=1.5)
    assert text.startswith("# Calibration\n\n**The search has not converged.**")
    assert "not peak to peak, not an effective value" in text
    assert "1.5 effective samples in 4 independent searches" in text and "at least 40 effective samples" in text
    for word in ("does not explain", "±", "effort", "## ", "friction", "p-value", "m/s²"):
        assert word not in text


def test_an_alternative_whose_search_has_not_converged_is_no_verdict():
    found = tables()
    found["alternatives"].loc[1, ["value", "log_bayes_factor", "effective"]] = [math.nan, math.nan, 3.0]
    template = (ROOT / "workflow/rules/machine/calibration.md").read_text(encoding="utf-8")
    text = page.make(template, **found, measurements="acceleration,velocity\n", prefix="mine")
    assert "| phase_shift | 0 rad | – | not known: its search has not converged |" in text
    first = text.partition("## Parameters")[0]
    assert "**The model explains" in first
    assert "- What is not known: whether another `phase_shift` than the stated one explains" in first
    assert "What is not known" not in first_screen()


def test_a_model_that_needs_many_mistakes_says_so_first():
    text = first_screen(misfits=2)
    assert text.startswith("# Calibration\n\n**The model explains the 4 measured velocities only if 2 of them are")


def test_a_trial_says_first_that_it_is_one():
    assert "trial" not in whole_page()
    for converged in (True, False):
        text = first_screen(effort=0.3, converged=converged)
        assert text.startswith("# Calibration\n\n**This is a trial, not a calibration:** `calibration.effort` is 0.3.")
    trial = tables(effort=0.3)
    assert "A trial with calibration.effort = 0.3" in overlay.make(trial["parameters"], trial["fit"])


def test_measurements_that_determine_nothing_recommend_no_parameters():
    text = first_screen(status=[NOT_DETERMINED] * 3)
    assert "What was found: nothing" in text and "measure more velocities, first at **45 m/s²**" in text
    assert "calibrated.yaml" not in text and "0.24" not in text


def test_the_overlay_has_the_best_parameters():
    found = tables()
    model = yaml.safe_load(overlay.make(found["parameters"], found["fit"]))["model"]
    assert model == {"friction": 0.24, "damping": 0.7, "stiffness": 4e5}
    assert all(isinstance(value, float) for value in model.values())
    assert yaml.safe_load(overlay.make(found["parameters"], found["fit"]))["parts"] == {"calibrated": True}


@pytest.mark.parametrize(
    "options",
    [{"explained": False}, {"alternative": True}, {"converged": False}, {"status": [NOT_DETERMINED] * 3}],
)
def test_there_is_no_overlay_without_parameters_that_can_be_trusted(options):
    found = tables(**options)
    with pytest.raises(JobError, match=r"no overlay|for an overlay"):
        overlay.make(found["parameters"], found["fit"])


def test_the_page_gives_the_monte_carlo_errors():
    text = whole_page()
    assert "| friction | 0.24 ± 0.002 | 0.23 ± 0.01 to 0.25 ± 0.01 |" in text and "4 independent searches" in text
