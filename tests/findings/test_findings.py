"""Findings from made-up tables whose answer is known, and verdicts that come out each way."""

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

import claims
from findings import chaos, proofs, states
from findings.finding import Finding, onset

AMPLITUDES = np.arange(20.0, 91.0)


def sweep(state, velocity=0.1, heights=(0.0, 1e-4)):
    """A sweep in which `state` and `velocity` are functions of amplitude and height, or constant."""
    rows = [(a, z) for a in AMPLITUDES for z in heights]
    table = pd.DataFrame(rows, columns=["acceleration", "z0"])
    table["state"] = [state(a, z) if callable(state) else state for a, z in rows]
    table["mean_velocity"] = [velocity(a, z) if callable(velocity) else velocity for a, z in rows]
    table["period"] = np.where(table.state == "chaos", 0, 1)
    return table


def both(table):
    return {"converged": table, "published": table}


@pytest.mark.parametrize(
    ("holds", "expected"),
    [
        ([0, 0, 1, 1], 3.0),
        ([1, 1, 1, 1], 1.0),
        ([0, 1, 0, 0, 1, 1, 1], 5.0),  # a single early one is no onset
        ([0, 0, 1, 1, 0, 1, 1], 3.0),  # nor does a window end what has begun
    ],
)
def test_onset(holds, expected):
    assert onset(np.arange(1.0, len(holds) + 1), holds) == expected


def test_no_onset():
    assert math.isnan(onset(np.arange(3.0), [False] * 3))


@pytest.mark.parametrize(
    ("published", "converged", "expected"),
    [
        ((1.0,), (1.0,), claims.REPRODUCED),
        ((2.0,), (1.0,), claims.REPRODUCED),
        ((1.0,), (2.0,), claims.PUBLISHED_ONLY),
        ((2.0,), (2.0,), claims.NOT_REPRODUCED),
        ((2.0,), (math.nan,), claims.NOT_REPRODUCED),
        ((), (1.0,), claims.REPRODUCED),
        ((), (2.0,), claims.NOT_REPRODUCED),
        ((1.0,), (), claims.REPRODUCED),
        ((2.0,), (), claims.NOT_REPRODUCED),
    ],
)
def test_verdicts(published, converged, expected):
    assert claims.verdict(Finding(published, converged), [[0.5, 1.5]]) == expected


CLAIMS = yaml.safe_load((Path(__file__).parents[2] / "config/config.yaml").read_text())["claims"]


def inside(low, high):
    if low is None or high is None:
        return (high if low is None else low) if (low, high) != (None, None) else 0.0
    return 0.5 * (low + high)


def beyond(low, high):
    return high + 1.0 if low is None else low - 1.0


@pytest.mark.parametrize("name", claims.FINDINGS)
def test_accepted_intervals_bring_each_verdict(name):
    accepted = CLAIMS[name]["accepted"]
    right = tuple(inside(*interval) for interval in accepted)
    assert claims.verdict(Finding(right, right), accepted) == claims.REPRODUCED
    for place, interval in enumerate(accepted):
        wrong = (*right[:place], beyond(*interval), *right[place + 1 :])
        assert claims.verdict(Finding(right, wrong), accepted) == claims.PUBLISHED_ONLY
        assert claims.verdict(Finding(wrong, wrong), accepted) == claims.NOT_REPRODUCED


@pytest.mark.parametrize("name", claims.FINDINGS)
def test_the_papers_own_numbers_are_accepted(name):
    claim = CLAIMS[name]
    for number, interval in zip(claim["paper"], claim["accepted"], strict=True):
        assert number is None or claims.holds((number,), [interval])


def test_notes_stand_beside_verdicts():
    claim = CLAIMS["C01"]
    table = claims.columns({"a": claim, "b": claim}, {"a": Finding((), (50.0,), "note 1"), "b": Finding((), (50.0,))})
    assert table["verdict"] == [claims.REPRODUCED] * 2
    assert table["reason"] == ["note 1", None]


def test_a_reason_begins_with_the_numbers_that_miss():
    table = claims.columns({"C01": CLAIMS["C01"]}, {"C01": Finding((50.0,), (60.0,), "because of 1")})
    assert table["verdict"] == [claims.PUBLISHED_ONLY]
    number = "critical amplitude in m/s²: 60 by the converged solution is not in [49, 51]"
    assert table["reason"] == [f"{number}; because of 1"]


def test_null_is_no_bound():
    assert claims.holds((1e300, -1e300), [[0.0, None], [None, 0.0]])
    assert not claims.holds((-1.0,), [[0.0, None]])


def test_reason_says_which_number_is_outside():
    claim = {"accepted": [[0.0, 1.0], [0.0, 1.0]], "quantities": ["height in mm", "width in mm"]}
    text = claims.outside(Finding((0.5, 0.5), (0.5, 3.25)), claim)
    assert text == "width in mm: 3.25 by the converged solution is not in [0, 1]"


def test_critical_acceleration_looks_at_the_start_at_rest():
    table = sweep(lambda a, z: "second" if a >= 50.0 or z > 0.0 else "first")
    assert states.critical_acceleration(both(table)).converged == (50.0,)


def test_interval_of_two_states():
    table = sweep(lambda a, z: "second" if a > 47.0 or (a >= 29.0 and z > 0.0) else "first")
    assert states.interval(both(table)).converged == (29.0, 47.0)
    assert all(math.isnan(end) for end in states.interval(both(sweep("first"))).converged)


def test_interval_by_the_reading_of_the_contact_force():
    table = sweep(lambda a, z: "second" if a > 47.0 or (a >= 29.0 and z > 0.0) else "first")
    finding = states.interval({**both(table), "tension": table.assign(tension="clip")})
    assert finding.reason.endswith("29 to 47 m/s² (clip)")


def test_onset_of_chaos_by_scatter_and_by_state():
    table = sweep(lambda a, z: "chaos" if a >= 63.0 else "second", lambda a, z: 0.1 + (z * 1e3 if a >= 55.0 else 0.0))
    finding = states.onset_of_chaos(both(table))
    assert (finding.published, finding.converged) == ((55.0,), (63.0,))
    assert "in between 100 % of the starts settle to a period (period 1 for 100 %)" in finding.reason
    late = sweep(lambda a, z: "chaos" if a >= 50.0 else "second", lambda a, z: 0.1 + (z * 1e3 if a >= 55.0 else 0.0))
    assert "nan" not in states.onset_of_chaos(both(late)).reason


def certificates(*stable):
    """Stable orbits at amplitudes, all different."""
    contact = np.linspace(0.01, 0.02, len(stable))
    return pd.DataFrame(
        {
            "acceleration": stable,
            "stability": "stable",
            "contact_time_low": contact - 1e-9,
            "contact_time_high": contact + 1e-9,
        }
    )


def test_what_is_proved_is_told():
    """Two stable orbits at 30 and at 40 m/s², one at 56 m/s²; open ones do not count."""
    proved = pd.concat(
        [certificates(30.0, 30.0, 40.0, 40.0, 56.0), certificates(45.0, 45.0, 70.0).assign(stability="open")]
    )
    assert "two stable motions are proved at 2 amplitudes from 30 to 40 m/s²" in proofs.both_states(
        {"certificates": proved}
    )
    assert "a stable periodic motion is proved at 1 amplitudes from 56 to 56 m/s²" in proofs.regular(
        {"certificates": proved}, 55.0
    )
    horseshoes = pd.DataFrame({"acceleration": [65.0, 80.0], "proved": [False, True]})
    assert "is proved at 80 m/s²" in proofs.chaotic({"horseshoes": horseshoes})
    assert [proofs.both_states({}), proofs.regular({}, 0.0), proofs.chaotic({})] == ["", "", ""]
    assert proofs.regular({"certificates": proved}, 60.0) == ""


def test_one_orbit_twice_is_not_two_motions():
    once = certificates(30.0)
    assert proofs.both_states({"certificates": pd.concat([once, once])}) == ""


def test_statements_name_what_is_proved():
    table = sweep(lambda a, z: "second" if a > 47.0 or (a >= 29.0 and z > 0.0) else "first")
    tables = {**both(table), "certificates": certificates(30.0, 30.0)}
    assert states.interval(tables).reason.endswith("(docs/certificates.md)")


def test_critical_heights_are_read_between_amplitudes():
    table = pd.DataFrame(
        {
            "acceleration": [29.0, 35.0, 35.0, 41.0],
            "z0": [3e-4, 1e-4, 4e-4, 0.5e-4],
            "crossing": [1, 1, 2, 1],
            "is_critical": [True, True, False, True],
        }
    )
    assert states.critical_height(38.0)(both(table)).converged == pytest.approx((0.075,))
    assert states.largest_critical_height(both(table)).converged == pytest.approx((0.3,))
    assert math.isnan(states.critical_height(50.0)(both(table)).converged[0])


def test_velocities_of_both_states():
    table = sweep(
        lambda a, z: "first" if a < 29.0 or (z == 0.0 and a <= 47.0) else "second",
        lambda a, z: 1e-3 * a if z == 0.0 and a <= 47.0 else 0.07 - 1e-4 * (a - 29.0),
    )
    tables = {**both(table), "tension": table[table.z0 == 0.0].assign(tension="clip")}
    assert states.first_velocity(tables).converged == pytest.approx((2.9, 4.7))
    assert states.second_velocity(tables).converged == pytest.approx((0.18,))
    assert states.first_velocity(tables).reason.endswith("4.70 cm/s (clip)")


def test_fit_is_that_of_the_regression():
    table = pd.DataFrame(
        {
            "fit": ["pymoo", "published", "valley", "valley"],
            "A": 0.004,
            "B": [-20.0, -19.5, -21.0, -18.0],
            "C": -1e-4,
            "error": [1e-11, 2e-11, 3e-11, 1.5e-11],
        }
    )
    finding = states.fit(both(table))
    assert finding.converged == (0.004, -20.0, -1e-4, 1e-11)
    assert "every B from -21 to -21" not in finding.reason  # 3e-11 is more than the paper's triple has
    assert "every B from -18 to -18" in finding.reason


def test_spread_of_onsets():
    straight = states.one_onset({"converged": sweep(lambda a, z: "chaos" if a >= 60.0 else "second")})
    assert (straight.published, straight.converged) == ((), (0.0,))
    slanted = sweep(lambda a, z: "chaos" if a >= 60.0 + 2e4 * z else "second")
    assert states.one_onset({"converged": slanted}).converged == (2.0,)


def test_early_chaos_of_some_heights_is_told():
    early = sweep(lambda a, z: "chaos" if a >= 63.0 or (a == 53.0 and z == 0.0) else "second")
    finding = states.one_onset({"converged": early})
    assert finding.converged == (0.0,)
    assert "from 53.00 to 53.00 m/s² already, for 50 % of the starts there" in finding.reason


def test_impact_line():
    velocity = np.array([-0.1, -0.05, 0.0, np.nan])
    table = pd.DataFrame({"impact_velocity": velocity, "impact_phase": -32.0 * velocity})
    assert states.impact_line({"converged": table}).converged == pytest.approx((-32.0, 0.0), abs=1e-12)


def spectrum(acceleration, signal, amplitudes):
    frequencies = 50.0 * np.arange(len(amplitudes))
    return pd.DataFrame(
        {"acceleration": acceleration, "signal": signal, "frequency": frequencies, "amplitude": amplitudes}
    )


def test_lines_of_spectra():
    vertical = [spectrum(40.0, "vz", [0.0, 1.0, 0.01]), spectrum(50.0, "vz", [0.0, 1.0, 0.5, 0.3, 0.01])]
    assert states.vertical_lines(both(pd.concat(vertical))).converged == (2.0,)
    horizontal = [spectrum(40.0, "vx", [1.0, 0.5, 0.2]), spectrum(50.0, "vx", [1.0, 0.01, 0.01])]
    assert states.horizontal_lines(both(pd.concat(horizontal))).converged == pytest.approx((2.0, 100.0))


def test_overlap_of_maps():
    low = pd.DataFrame({"state": ["first", "first", "second", "second"]})
    high = pd.DataFrame({"state": ["first", "second", "first", "chaos"]})
    maps = {
        f"{place}_{level}": table for place in ("height", "velocity") for level, table in (("low", low), ("high", high))
    }
    finding = states.overlap(maps)
    assert finding.converged == (0.5, 0.25, 0.5, 0.25)
    assert finding.reason.startswith("0 points")  # the chaos of the higher amplitude is not counted


def test_mapped_states():
    table = pd.DataFrame({"state": ["first", "second", "first"], "mapped_state": ["first", "first", None]})
    assert states.mapped({"converged": table}).converged == (0.5,)


def test_error_of_euler_in_regular_motion_only():
    converged = sweep(lambda a, z: "chaos" if a > 60.0 else "second")
    published = converged.assign(mean_velocity=np.where(converged.state == "chaos", 1.0, 0.101))
    estimates = {"converged_exponent": exponents(60.0), "published_exponent": exponents(50.0)}
    finding = states.euler_error({"converged": converged, "published": published, **estimates})
    assert finding.published == pytest.approx((math.nan, 0.01, 61 / 71), nan_ok=True)
    assert "wrong at 10 of 71 amplitudes" in finding.reason


def strobes(z0, values):
    return pd.DataFrame({"z0": z0, "time": 0.02 * np.arange(len(values)), "z": values, "vz": values})


def test_a_motion_comes_back_after_its_period():
    period_3 = np.tile([1.0, -0.5, 0.2], 43)[:128]
    assert chaos.least_return(strobes(0.0, period_3)) == (0.0, 3)
    assert chaos.least_return(strobes(0.0, np.tile(np.arange(65.0), 2)[:128]))[0] > chaos.BACK


def test_share_without_a_period():
    noise = strobes(0.0, np.random.default_rng(1).normal(size=128))
    regular = strobes(1e-4, np.tile([1.0, -1.0], 64))
    assert chaos.no_period(both(pd.concat([noise, regular]))).converged == (0.5,)


def test_irregular_dependence():
    z0 = np.linspace(0.0, 1e-3, 400)
    noise = np.random.default_rng(1).normal(size=400)
    step = np.where(z0 > 5e-4, 1.0, 0.0)
    for velocity, low, high in ((noise, 0.8, 1.1), (step, 0.0, 0.01)):
        table = pd.DataFrame({"z0": z0, "mean_velocity": velocity})
        assert low <= chaos.irregular(both(table)).converged[0] <= high


def exponents(first_positive, crossing=None):
    values = np.where(first_positive <= AMPLITUDES, 1.0, -1.0)
    if crossing:
        values[crossing <= AMPLITUDES] = -1.0
    return pd.DataFrame({"acceleration": AMPLITUDES, "lambda": values})


def test_height_estimate():
    assert chaos.height_estimate(both(exponents(42.0, crossing=55.0))).converged == (42.0, 1.0)


def perturbations():
    """The estimate of a settled motion over the perturbation, by both methods."""
    table = pd.DataFrame(
        {
            "panel": "perturbation",
            "case": "orbit_phase",
            "estimator": ["euler", "euler", "event", "event"],
            "epsilon": [1e-8, 1e-6] * 2,
            "value": [0.5, 1.5, -9.0, -8.0],
        }
    )
    table.attrs = {"exponent": {"cases": {"orbit_phase": {"acceleration": 55.0}}}}
    return table


def estimates(published, converged):
    """The tables of C19 with onsets as given."""
    return {
        "published": exponents(published),
        "converged": exponents(converged),
        "states": sweep("second"),
        "estimates": perturbations(),
    }


def test_phase_estimate():
    finding = chaos.phase_estimate(estimates(50.0, 59.0))
    assert (finding.published, finding.converged) == ((50.0,), (59.0,))
    assert "positive at 100 % of the amplitudes by Euler" in finding.reason
    assert "at 0 % of the amplitudes converged" in finding.reason
    assert "100 % settle to a period" in finding.reason
    assert "+0.50 to +1.50 1/s by Euler and -9.00 to -8.00 1/s converged" in finding.reason


def test_portraits_in_the_order_of_the_states():
    table = pd.DataFrame(
        {
            "acceleration": [80.0, 40.0, 80.0, 40.0],
            "z0": [0.0, 3e-4, 3e-4, 0.0],
            "dimension": [1.9, 1.1, 1.8, 1.0],
            "error": 0.1,
        }
    )
    assert chaos.portraits(both(table)).converged == (1.0, 1.1, 1.9)


def test_onset_by_dimension():
    table = pd.DataFrame({"acceleration": AMPLITUDES, "dimension": np.where(AMPLITUDES >= 62.0, 2.0, 1.0)})
    tables = {
        **both(table),
        "converged_exponent": exponents(59.0),
        "published_exponent": exponents(62.0),
        "states": sweep(lambda a, z: "chaos" if a >= 63.0 else "second"),
    }
    finding = chaos.predicted_onset(tables)
    assert (finding.published, finding.converged) == ((0.0, 1.0), (3.0, 1.0))
    assert "1.00 to 2.00 in that and 2.00 to 2.00 in chaos" in finding.reason
