"""Findings from made-up tables with known answers, and each kind of verdict."""

import math

import numpy as np
import pandas as pd
import pytest
from project import ROOT

from conveyor_pipeline.paper.claims import about_chaos, about_proofs, about_states, verdicts
from conveyor_pipeline.paper.claims.finding import Finding, onset
from conveyor_pipeline.paper.claims.statements import read_claims

AMPLITUDES = np.arange(20.0, 91.0)


def sweep(state, velocity=0.1, heights=(0.0, 1e-4)):
    """A sweep in which `state` and `velocity` are functions of amplitude and height, or constant."""
    rows = [(a, z) for a in AMPLITUDES for z in heights]
    table = pd.DataFrame(rows, columns=["acceleration", "z0"])
    table["state"] = [state(a, z) if callable(state) else state for a, z in rows]
    table["mean_velocity"] = [velocity(a, z) if callable(velocity) else velocity for a, z in rows]
    table["period"] = np.where(table.state == "chaos", 0, 1)
    return table


NOT_PROVED = pd.DataFrame({"acceleration": [80.0], "proved": [False]})  # horseshoes


def both(table):
    return {"converged": table, "euler": table}


@pytest.mark.parametrize(
    ("holds", "expected"),
    [
        ([0, 0, 1, 1], 3.0),
        ([1, 1, 1, 1], 1.0),
        ([0, 1, 0, 0, 1, 1, 1], 5.0),  # a single early point is not an onset
        ([0, 0, 1, 1, 0, 1, 1], 3.0),  # a window does not end the property
        ([0, 0, 0, 1], 4.0),
    ],
)
def test_onset(holds, expected):
    assert onset(np.arange(1.0, len(holds) + 1), holds) == expected


@pytest.mark.parametrize("holds", [[0, 0, 0], [0, 1, 0, 0], [1, 0], [1, 1, 0, 0, 0]])
def test_never_is_an_answer(holds):
    """A few early points do not make the last amplitude an onset."""
    assert math.isnan(onset(np.arange(float(len(holds))), holds))


def numbers(quantities):
    """The values of the quantities of a finding."""
    return tuple(quantities.values())


def quantities(**accepted):
    """Quantities of a claim with these accepted intervals."""
    return {name: {"is": name, "paper": None, "accepted": interval} for name, interval in accepted.items()}


@pytest.mark.parametrize(
    ("euler", "converged", "expected"),
    [
        ({"a": 1.0}, {"a": 1.0}, verdicts.REPRODUCED),
        ({"a": 2.0}, {"a": 1.0}, verdicts.REPRODUCED),
        ({"a": 1.0}, {"a": 2.0}, verdicts.PAPER_METHOD_ONLY),
        ({"a": 2.0}, {"a": 2.0}, verdicts.NOT_REPRODUCED),
        ({"a": 2.0}, {"a": math.nan}, verdicts.NOT_REPRODUCED),
        ({}, {"a": 1.0}, verdicts.REPRODUCED),
        ({}, {"a": 2.0}, verdicts.NOT_REPRODUCED),
        ({"a": 1.0}, {}, verdicts.REPRODUCED),
        ({"a": 2.0}, {}, verdicts.NOT_REPRODUCED),
    ],
)
def test_verdicts(euler, converged, expected):
    assert verdicts.verdict(Finding(euler, converged), quantities(a=[0.5, 1.5])) == expected


def test_a_missing_quantity_is_an_error():
    with pytest.raises(KeyError, match="b"):
        verdicts.verdict(Finding({}, {"a": 1.0}), quantities(a=[0.5, 1.5], b=[0.0, 1.0]))


CLAIMS = read_claims()


def test_a_claim_names_its_finding_its_tables_and_its_settings():
    table = pd.DataFrame({"acceleration": [30.0, 40.0], "z0": [2e-4, 1e-4], "is_critical": True})
    claim = {
        "finding": "about_states.critical_height",
        "tables": {"euler": "a", "converged": "b"},
        "settings": {"acceleration": 35.0},
    }
    found = verdicts.evaluate(claim, {"a": table.assign(z0=3e-4), "b": table})
    assert (*found.euler.values(), *found.converged.values()) == pytest.approx((0.3, 0.15))


@pytest.mark.parametrize("name", CLAIMS)
def test_the_papers_own_numbers_are_accepted(name):
    for quantity in CLAIMS[name]["quantities"].values():
        assert quantity["paper"] is None or verdicts.is_accepted(quantity["paper"], quantity["accepted"])


def test_a_reproduced_claim_keeps_its_note():
    claim, held = CLAIMS["C01"], {"critical_amplitude": 50.0}
    table = verdicts.columns({"a": claim, "b": claim}, {"a": Finding({}, held, "note 1"), "b": Finding({}, held)})
    assert table["verdict"] == [verdicts.REPRODUCED] * 2
    assert table["reason"] == ["note 1", None]


def test_a_reason_begins_with_the_numbers_that_miss():
    finding = Finding({"critical_amplitude": 50.0}, {"critical_amplitude": 60.0}, "Because of 1")
    table = verdicts.columns({"C01": CLAIMS["C01"]}, {"C01": finding})
    assert table["verdict"] == [verdicts.PAPER_METHOD_ONLY]
    number = "critical amplitude in m/s²: 60 by the converged solution; accepted: [49, 51]"
    assert table["reason"] == [f"{number}. Because of 1"]


def test_null_means_no_bound():
    assert verdicts.is_accepted(1e300, [0.0, None])
    assert verdicts.is_accepted(-1e300, [None, 0.0])
    assert not verdicts.is_accepted(-1.0, [0.0, None])
    assert not any(verdicts.is_accepted(math.nan, interval) for interval in ([0.0, None], [None, 0.0], [None, None]))


def test_reason_says_which_number_is_outside():
    claimed = quantities(height=[0.0, 1.0], width=[0.0, 1.0])
    text = verdicts.describe_misses(Finding({"height": 0.5, "width": 0.5}, {"height": 0.5, "width": 3.25}), claimed)
    assert text == "width: 3.25 by the converged solution; accepted: [0, 1]"
    text = verdicts.describe_misses(Finding({"height": 2.0, "width": 0.5}, {"height": 3.0, "width": 0.5}), claimed)
    assert text == "height: 2 by the paper's method and 3 by the converged solution; accepted: [0, 1]"


def test_critical_acceleration_uses_the_part_at_rest():
    """Of each method in its own table."""
    late, early = (sweep(lambda a, z, at=at: "second" if a >= at or z > 0.0 else "first") for at in (50.0, 45.0))
    finding = about_states.critical_acceleration(converged=late, euler=early)
    assert (numbers(finding.converged), numbers(finding.euler)) == ((50.0,), (45.0,))


def test_interval_of_two_states():
    late, early = (
        sweep(lambda a, z, end=end: "second" if a > end or (a >= 29.0 and z > 0.0) else "first") for end in (47.0, 40.0)
    )
    finding = about_states.interval(converged=late, euler=early)
    assert (numbers(finding.converged), numbers(finding.euler)) == ((29.0, 47.0), (29.0, 40.0))
    assert all(math.isnan(end) for end in numbers(about_states.interval(**both(sweep("first"))).converged))


def test_interval_on_a_coarser_axis():
    """Both states from 28 to 48 m/s², of which an axis 20, 23, … has 29 and 47."""
    table = sweep(lambda a, z: "second" if a > 48.0 or (a >= 28.0 and z > 0.0) else "first")
    heights = pd.DataFrame({"acceleration": [29.0, 32.0, 35.0]})
    finding = about_states.interval(**both(table), heights=heights)
    assert numbers(finding.converged) == (28.0, 48.0, 29.0, 47.0)
    assert (
        "In steps of 3 m/s², which are assumed for Fig. 9, the part from rest changes its state at 50 m/s²"
        in finding.note
    )


def test_influences_on_the_critical_amplitude():
    changes = pd.DataFrame(
        {
            "kind": ["critical_amplitude"] * 3 + ["fold"],
            "parameter": ["mass", "stiffness", "damping", "mass"],
            "elasticity": [-0.3, -0.04, 0.3, 9.0],
            "status": ["ok", "ok", "not found again beside it", "ok"],
        }
    )
    moves = pd.concat(
        sweep(lambda a, z, mu=mu: "second" if a >= 50.0 * mu else "first").assign(friction=mu) for mu in (0.5, 1.0)
    )
    finding = about_states.influences(changes=changes, frictions=moves)
    assert numbers(finding.converged) == pytest.approx((0.3, 0.04, math.nan, 1.0), nan_ok=True)
    fixed = pd.concat(sweep(lambda a, z: "second" if a >= 50.0 else "first").assign(friction=mu) for mu in (0.5, 1.0))
    assert about_states.influences(changes=changes, frictions=fixed).converged["friction"] == 0.0


def test_interval_by_tension_mode():
    table = sweep(lambda a, z: "second" if a > 47.0 or (a >= 29.0 and z > 0.0) else "first")
    finding = about_states.interval(**both(table), tension=table.assign(tension="clip"))
    assert finding.note.endswith("29 to 47 m/s² (clip)")


def test_onset_of_chaos_by_scatter_and_by_state():
    table = sweep(lambda a, z: "chaos" if a >= 63.0 else "second", lambda a, z: 0.1 + (z * 1e3 if a >= 55.0 else 0.0))
    finding = about_states.onset_of_chaos(**both(table), certificates=certificates())
    assert (numbers(finding.euler), numbers(finding.converged)) == ((55.0, 63.0), (55.0, 63.0))
    assert "settle to chaos only from 63 m/s² on" in finding.note
    early = sweep(
        lambda a, z: "first" if a < 50.0 and z == 0.0 else "chaos" if a >= 63.0 else "second",
        lambda a, z: 0.1 + (z * 1e3 if a >= 55.0 or a in (50.0, 52.0) else 0.0),
    )
    note = about_states.onset_of_chaos(**both(early), certificates=certificates()).note
    assert (
        "From 55 m/s² on, velocities scatter at all amplitudes, and at 2 of 5 amplitudes between there and 49 m/s²"
        in note
    )
    assert (
        "Between these amplitudes, 100 % of the motions settle to a periodic motion (period 1 for 100 %)"
        in finding.note
    )
    late = sweep(lambda a, z: "chaos" if a >= 50.0 else "second", lambda a, z: 0.1 + (z * 1e3 if a >= 55.0 else 0.0))
    assert "nan" not in about_states.onset_of_chaos(**both(late), certificates=certificates()).note


@pytest.mark.parametrize("size", [0.01, 10.0])
def test_scatter_is_relative(size):
    """Of velocities v and (1 + d) v the standard deviation is d/√2 v: 1.4 % of the mean up to 55 m/s², then 13 %."""
    table = sweep("second", lambda a, z: size * (1.0 + (0.0 if z == 0.0 else 0.2 if a >= 55.0 else 0.02)))
    assert about_states.scatter_onset(table) == 55.0


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


def test_notes_name_what_is_proved():
    """Two stable orbits at 30 and at 40 m/s², one at 56 m/s²; orbits with undecided stability do not count."""
    proved = pd.concat(
        [certificates(30.0, 30.0, 40.0, 40.0, 56.0), certificates(45.0, 45.0, 70.0).assign(stability="open")]
    )
    assert "Two stable motions are proved at 2 amplitudes from 30 to 40 m/s²" in about_proofs.describe_coexistence(
        proved
    )
    periodic = about_proofs.describe_periodic(proved, 55.0)
    assert "A stable periodic motion is proved at 1 amplitudes from 56 to 56 m/s²" in periodic
    horseshoes = pd.DataFrame({"acceleration": [65.0, 80.0], "proved": [False, True]})
    assert "is proved at 80 m/s²" in about_proofs.describe_chaos(horseshoes)
    assert about_proofs.describe_periodic(proved, 60.0) == ""


def test_the_lowest_fold_is_proved():
    """Other bifurcations and folds without a proof do not count."""
    bifurcations = pd.DataFrame(
        {
            "kind": ["period_doubling", "fold", "fold", "fold"],
            "proved": [True, False, True, True],
            "acceleration_low": [10.0, 20.0, 40.0, 30.0],
        }
    )
    assert about_proofs.lowest_fold(bifurcations) == 30.0
    assert np.isnan(about_proofs.lowest_fold(bifurcations[:2]))


def test_notes_without_proofs_are_empty():
    assert about_proofs.describe_coexistence(None) == ""
    assert about_proofs.describe_periodic(certificates(), 0.0) == ""
    assert about_proofs.describe_chaos(NOT_PROVED) == ""


def test_one_orbit_twice_is_not_two_motions():
    once = certificates(30.0)
    assert about_proofs.describe_coexistence(pd.concat([once, once])) == ""


def test_statements_name_what_is_proved():
    table = sweep(lambda a, z: "second" if a > 47.0 or (a >= 29.0 and z > 0.0) else "first")
    tables = {**both(table), "certificates": certificates(30.0, 30.0)}
    assert about_states.interval(**tables).note.endswith("(docs/certificates.md)")


def test_critical_heights_are_read_between_amplitudes():
    table = pd.DataFrame(
        {
            "acceleration": [29.0, 35.0, 35.0, 41.0],
            "z0": [3e-4, 1e-4, 4e-4, 0.5e-4],
            "crossing": [1, 1, 2, 1],
            "is_critical": [True, True, False, True],
        }
    )
    assert numbers(about_states.critical_height(**both(table), acceleration=38.0).converged) == pytest.approx((0.075,))
    assert math.isnan(*numbers(about_states.critical_height(**both(table), acceleration=50.0).converged))


def test_largest_critical_height_over_all_amplitudes():
    heights = pd.DataFrame({"acceleration": [29.0, 32.0, 35.0, 50.0]})
    rising = pd.DataFrame({"acceleration": [28.0, 29.0, 35.0], "z0": [4e-4, 1e-4, 3e-4], "is_critical": True})
    rising["crossing"] = 1
    rising["state_above"] = "second"
    finding = about_states.largest_critical_height(**both(rising), heights=heights)
    assert numbers(finding.converged) == pytest.approx(
        (0.3, 0.0)
    )  # not the height at 28 m/s² or at the lowest amplitude
    assert finding.note.startswith("The largest height occurs at 35 m/s²")
    again = {"crossing": 2, "state_above": "first", "is_critical": False}
    returns = pd.DataFrame([{"acceleration": a, "z0": 4.5e-4} | again for a in (28.0, 29.0)])  # 28 is not in Fig. 9
    finding = about_states.largest_critical_height(**both(pd.concat([rising, returns])), heights=heights)
    assert numbers(finding.converged) == pytest.approx((0.3, 1.0))
    assert finding.note.endswith("At 29 m/s², the first state returns above 0.45 mm")


def test_velocities_of_both_states():
    table = sweep(
        lambda a, z: "first" if a < 29.0 or (z == 0.0 and a <= 47.0) else "second",
        lambda a, z: 1e-3 * a if z == 0.0 and a <= 47.0 else 0.07 - 1e-4 * (a - 29.0),
    )
    ends = table[table.acceleration.isin([29.0, 47.0])]
    heights = table[table.acceleration.between(29.0, 47.0)]
    # The velocities are proportional to the friction.
    frictions = pd.concat(
        ends.assign(friction=mu, mean_velocity=ends.mean_velocity * mu) for mu in np.arange(1, 21) / 10.0
    )
    tables = {**both(heights), "tension": table[table.z0 == 0.0].assign(tension="clip"), "frictions": frictions}
    tables["velocities_of"] = {"lower_end": [1.4, 1.8], "upper_end": [2.3, 4.75], "fall": [0.1, 0.13]}
    assert numbers(about_states.first_velocity(**tables).converged) == pytest.approx((2.9, 4.7))
    fine = heights.assign(mean_velocity=heights.mean_velocity.where(heights.acceleration != 40.0, 0.06))
    finding = about_states.second_velocity(**tables, fine=fine)
    assert numbers(finding.converged) == pytest.approx((0.18,))
    assert "6.000 cm/s, is at 40 m/s²; the largest fall within the interval is 1 cm/s. " in finding.note
    tables["velocities_of"]["fall"] = [0.9, 1.1]
    note = about_states.second_velocity(**tables, fine=fine).note
    assert "is 1 cm/s, which would be accepted: the verdict depends on the reading. " in note
    tables["velocities_of"]["fall"] = [0.1, 0.13]
    note = about_states.first_velocity(**tables).note
    assert "4.70 cm/s (clip)" in note
    assert "the first state's velocity at the lower end at frictions of 0.5 to 0.6, at the upper end" in note
    assert (
        "at frictions of 0.5 to 1, the second state's fall at frictions of 0.6 to 0.7. All come out at 0.6 to 0.6"
        in note
    )
    tables["velocities_of"]["fall"] = [0.3, 0.36]
    # At 0.6 the velocities are 1.74 and 2.82, 6 % below its interval, and the fall is 0.108, 10 % below its own.
    tables["velocities_of"] = {"lower_end": [1.4, 1.8], "upper_end": [3.0, 3.5], "fall": [0.12, 0.13]}
    note = about_states.second_velocity(**tables, fine=heights).note
    assert note.endswith(
        "At 0.6 they come nearest: each lies within its accepted interval or misses it by at most 10.0 % of its end"
    )
    # With amplitudes at which no other friction was tried, and without a second state.
    between = heights[heights.acceleration.between(30.0, 40.0)]
    note = about_states.second_velocity(**{**tables, **both(between)}, fine=heights).note
    assert note.endswith("No other friction was tried at 30 m/s² and 40 m/s²")
    tables["frictions"] = frictions.assign(state="first")
    note = about_states.second_velocity(**tables, fine=heights).note
    assert note.endswith("the second state's fall at none. No friction gives all of them")


def test_both_errors_of_the_fit_are_those_of_the_same_amplitudes():
    fits = pd.DataFrame(
        {
            "fit": ["pymoo", "paper", "valley", "valley"],
            "A": 0.004,
            "B": [-20.0, -19.5, -21.0, -18.0],
            "C": -1e-4,
            "error": [1e-11, 2e-11, 3e-11, 1.5e-11],
        }
    )
    fits.attrs["acceleration"] = [29.0, 47.0]

    def heights(acceleration, misses, critical):
        """Heights beside the curve of the paper's coefficients."""
        acceleration = np.array(acceleration)
        z0 = 0.004 / (acceleration - 19.5) - 1e-4 + np.array(misses)
        return pd.DataFrame({"acceleration": acceleration, "z0": z0, "is_critical": critical})

    # Far from the curve outside the fitted amplitudes, and where the height is not critical.
    fine = heights(
        [28.0, 29.0, 30.0, 31.0, 32.0, 33.0, 33.0],
        [1.0, 3e-6, 1e-6, 5e-6, 1e-6, 4e-6, 1.0],
        [True, True, True, True, True, True, False],
    )
    coarse = heights([29.0, 31.0, 33.0], [1e-6, 1e-6, 2e-6], True)
    finding = about_states.fit(converged=fine, euler=coarse, regression=fits)
    assert numbers(finding.euler) == pytest.approx((2e-12,))
    assert numbers(finding.converged) == pytest.approx((50e-12 / 3.0,))
    assert "means over the 3 amplitudes at which both methods have a critical height" in finding.note
    assert "over all 5 amplitudes of the converged heights, the error is 1.04e-11 m²" in finding.note
    missing = about_states.fit(converged=fine[fine.acceleration != 33.0], euler=coarse, regression=fits)
    assert numbers(missing.euler) == pytest.approx((1e-12,))
    apart = about_states.fit(
        converged=fine, euler=coarse.assign(acceleration=coarse.acceleration + 0.5), regression=fits
    )
    assert np.isnan(numbers(apart.converged)) and np.isnan(numbers(apart.euler))
    assert "misses the converged heights by at most 5 µm (at 31 m/s²; median 3 µm)" in finding.note
    # The other one has a larger error than the paper's triple.
    assert "every B from -18 to -18" in finding.note


def onset_of(table):
    """C11 for a map over the initial height, and parts on the plate that become chaotic at 59 m/s²."""
    on_plate = sweep(lambda a, z: "chaos" if a >= 59.0 else "first", heights=(-1e-4,))
    return about_states.one_onset(converged=table, on_plate=on_plate)


def test_spread_of_onsets():
    straight = onset_of(sweep(lambda a, z: "chaos" if a >= 60.0 else "second"))
    assert (numbers(straight.euler), numbers(straight.converged)) == ((), (0.0, 0.0))
    slanted = sweep(lambda a, z: "chaos" if a >= 60.0 + 2e4 * z else "second")
    assert numbers(onset_of(slanted).converged) == (2.0, 2.0)


def test_early_chaos_of_some_heights_is_noted():
    early = sweep(lambda a, z: "chaos" if a >= 63.0 or (a == 53.0 and z == 0.0) else "second")
    finding = onset_of(early)
    assert numbers(finding.converged) == (0.0, 10.0)
    assert "For 50 % of the heights, chaos occurs before all onsets, from 53 m/s² on" in finding.note
    assert "Chaos and regular motion coexist, depending on the initial height, at 53.00 m/s²" in finding.note
    assert (
        "heights from 0 to 0.1 mm. For a part that starts on the plate, and so lower, the onset is 59 m/s²"
        in finding.note
    )
    assert finding.note.endswith("regular motion remains nowhere, on an axis in steps of 1.000 m/s²")
    windows = sweep(lambda a, z: "chaos" if a >= 63.0 and a not in (71.0, 72.0) else "second")
    assert onset_of(windows).note.endswith("in windows only: 71.00 to 72.00 m/s², on an axis in steps of 1.000 m/s²")


def test_impact_line():
    velocity = np.array([-0.1, -0.05, 0.0, np.nan])
    table = pd.DataFrame({"impact_velocity": velocity, "impact_phase": -32.0 * velocity})
    assert numbers(about_states.impact_line(converged=table).converged) == pytest.approx((-32.0, 0.0), abs=1e-12)


def spectrum(acceleration, signal, amplitudes):
    frequencies = 50.0 * np.arange(len(amplitudes))
    return pd.DataFrame(
        {"acceleration": acceleration, "signal": signal, "frequency": frequencies, "amplitude": amplitudes}
    )


def test_lines_of_spectra():
    vertical = [spectrum(40.0, "vz", [0.0, 1.0, 0.01]), spectrum(50.0, "vz", [0.0, 1.0, 0.5, 0.3, 0.01])]
    assert numbers(about_states.vertical_lines(**both(pd.concat(vertical))).converged) == (2.0,)
    horizontal = [spectrum(40.0, "vx", [1.0, 0.5, 0.2]), spectrum(50.0, "vx", [1.0, 0.01, 0.01])]
    finding = about_states.horizontal_lines(**both(pd.concat(horizontal)))
    assert numbers(finding.converged) == pytest.approx((2.0, 100.0))
    assert "with 0.5 %, the first state has 2 lines and the second 2" in finding.note


def test_overlap_of_maps():
    low = pd.DataFrame({"state": ["first", "first", "second", "second"]})
    high = pd.DataFrame({"state": ["first", "second", "first", "chaos"]})
    maps = {
        f"{place}_{level}": table for place in ("height", "velocity") for level, table in (("low", low), ("high", high))
    }
    finding = about_states.overlap(**maps)
    assert numbers(finding.converged) == pytest.approx((1.0 / 3.0, 0.25, 1.0 / 3.0, 0.25))
    assert "first state 50.0 % (Fig. 18) and 50.0 % (Fig. 19), second state 0.0 % and 0.0 %" in finding.note
    assert " 0 points" in finding.note  # the chaos of the higher amplitude is not counted


def test_chaos_at_the_lower_amplitude_is_not_shared():
    low, high = (pd.DataFrame({"state": states}) for states in (["first", "chaos", "second"], ["first"] * 3))
    maps = {
        f"{place}_{level}": one for place in ("height", "velocity") for level, one in (("low", low), ("high", high))
    }
    assert about_states.overlap(**maps).converged["shared_height"] == pytest.approx(1.0 / 3.0)


def test_mapped_states():
    table = pd.DataFrame({"state": ["first", "second", "first"], "mapped_state": ["first", "first", None]})
    assert numbers(about_states.mapped(converged=table).converged) == (0.5,)


def test_error_of_euler_in_regular_motion_only():
    converged = sweep(lambda a, z: "chaos" if a > 60.0 else "second")
    euler = converged.assign(mean_velocity=np.where(converged.state == "chaos", 1.0, 0.101))
    estimates = {"converged_exponent": exponents(59.0), "euler_exponent": exponents(50.0)}
    # One motion is undecided, so that the right reading is not known there.
    states = sweep(lambda a, z: "undecided" if a == 80.0 else "chaos" if a >= 61.0 else "second")
    states.loc[states.state == "undecided", "period"] = 0
    finding = about_states.euler_error(converged=converged, euler=euler, states=states, **estimates)
    assert numbers(finding.euler) == pytest.approx((math.nan, 0.01, 62 / 71), nan_ok=True)
    assert "wrong at 11 of 70 amplitudes by the paper's method, half" in finding.note
    assert "and at 2 by the converged solution" in finding.note
    assert "underestimates the mean velocity in 0 of 82 runs" in finding.note


def strobes(z0, values):
    return pd.DataFrame({"z0": z0, "time": 0.02 * np.arange(len(values)), "z": values, "vz": values})


def test_a_motion_returns_after_its_period():
    period_3 = np.tile([1.0, -0.5, 0.2], 43)[:128]
    assert about_chaos.closest_return(strobes(0.0, period_3)) == (0.0, 3)
    assert about_chaos.closest_return(strobes(0.0, np.tile(np.arange(65.0), 2)[:128]))[0] > about_chaos.CLOSE


def test_a_motion_that_returns_only_to_a_fifth_of_its_extent_has_no_period():
    """A motion that returns to a fiftieth of its extent has one. The largest distance in the last cycles counts."""
    to_and_fro, one = np.tile([1.0, -1.0], 64), np.arange(128) == 100
    coarse, fine = strobes(0.0, to_and_fro - 0.2 * one), strobes(1e-4, to_and_fro - 0.02 * one)
    assert about_chaos.closest_return(coarse) == (pytest.approx(0.2), 2)
    assert about_chaos.closest_return(fine) == (pytest.approx(0.02), 2)
    assert numbers(about_chaos.no_period(**both(pd.concat([coarse, fine])), horseshoes=NOT_PROVED).converged) == (0.5,)


def test_irregular_dependence():
    z0 = np.linspace(0.0, 1e-3, 400)
    noise = np.random.default_rng(1).normal(size=400)
    step = np.where(z0 > 5e-4, 1.0, 0.0)
    for velocity, low, high in ((noise, 0.8, 1.1), (step, 0.0, 0.01)):
        table = pd.DataFrame({"z0": z0, "mean_velocity": velocity})
        assert low <= numbers(about_chaos.irregular(**both(table)).converged)[0] <= high


def exponents(first_positive, crossing=None):
    values = np.where(first_positive <= AMPLITUDES, 1.0, -1.0)
    if crossing:
        values[crossing <= AMPLITUDES] = -1.0
    return pd.DataFrame({"acceleration": AMPLITUDES, "lambda": values})


def test_height_estimate():
    assert numbers(about_chaos.height_estimate(**both(exponents(42.0, crossing=55.0))).converged) == (42.0, 1.0)


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
    return table


def moved_impacts():
    """Impacts move in the converged solution only; larger perturbations and earlier times do not count."""
    table = pd.DataFrame(
        {
            "method": ["euler", "event", "euler", "euler"],
            "epsilon": [1e-8, 1e-8, 1e-3, 1e-8],
            "time_shift": [3e-11, 3e-11, 3e-6, 3e-11],
            "time": [1.0, 1.0, 1.0, 0.5],
            "impacts": [50, 50, 50, 25],
            "moved": [0, 50, 50, 25],
            "mean_shift": [0.0, 1.0, 1.0, 0.0],
        }
    )
    return table


def estimates(euler, converged):
    """The tables of C19 with onsets as given."""
    return {
        "euler": exponents(euler),
        "converged": exponents(converged),
        "states": sweep(lambda a, z: "chaos" if a >= 61.0 else "second"),
        "estimates": perturbations(),
        "moved": moved_impacts(),
        "certificates": certificates(),
    }


def test_phase_estimate():
    finding = about_chaos.phase_estimate(**estimates(50.0, 59.0))
    assert (numbers(finding.euler), numbers(finding.converged)) == ((50.0,), (59.0,))
    assert "positive at 100 % of the amplitudes by the paper's method" in finding.note
    assert "at 0 % of the amplitudes by the converged solution" in finding.note
    assert "There, 100 % of these trajectories settle to a periodic motion" in finding.note
    assert "stays chaotic is 61 m/s²" in finding.note
    assert "+0.50 to +1.50 1/s by the paper's method and -9.00 to -8.00 1/s by the converged solution" in finding.note
    assert "By the paper's method, 0 of 50 impacts move." in finding.note
    assert "the impacts of the converged solution move by 1.000 of it" in finding.note


def test_portraits_in_the_order_of_the_states():
    table = pd.DataFrame(
        {
            "acceleration": [80.0, 40.0, 80.0, 40.0],
            "z0": [0.0, 3e-4, 3e-4, 0.0],
            "dimension": [1.9, 1.1, 1.8, 1.0],
            "error": 0.1,
        }
    )
    assert numbers(about_chaos.portraits(**both(table)).converged) == (1.0, 1.1, 1.9)


def test_the_size_of_a_perturbation_explains_positive_exponents():
    tables = {"large": exponents(42.0), "large_euler": exponents(45.0), **both(exponents(50.0))}
    for table in tables.values():
        table.attrs = {"epsilon": 1e-8}
    finding = about_chaos.size_of_perturbation(**tables, acceleration=50.0)
    assert (numbers(finding.euler), numbers(finding.converged)) == ((5.0, 0.0), (8.0, 0.0))


def test_fluctuation_is_that_between_chaotic_neighbours():
    """A jump into chaos is none, nor is the change from 1.7 to 2 across a missing value."""
    dimension = np.where(
        AMPLITUDES >= 72.0, 2.0, np.where(AMPLITUDES >= 65.0, 1.7, np.where(AMPLITUDES >= 60.0, 1.6, 1.0))
    )
    dimension[AMPLITUDES == 72.0] = math.nan
    table = pd.DataFrame({"acceleration": AMPLITUDES, "dimension": dimension})
    # In the lower height, the motion is chaotic from 60 m/s² on.
    states = sweep(lambda a, z: "chaos" if a >= 60.0 and z == 0.0 else "second")
    finding = about_chaos.fluctuation(**both(table), states=states)
    assert numbers(finding.converged) == pytest.approx((0.1,))
    assert "converged dimension changes by up to 0.60" in finding.note


def test_onset_by_dimension():
    dimension = np.where(AMPLITUDES >= 62.0, 2.0, 1.0)
    table = pd.DataFrame({"acceleration": AMPLITUDES, "dimension": dimension, "status": "ok"})
    table.loc[table.acceleration == 25.0, ["dimension", "status"]] = math.nan, "interval too wide"
    tables = {
        **both(table),
        "converged_exponent": exponents(59.0),
        "euler_exponent": exponents(62.0),
        "states": sweep(lambda a, z: "chaos" if a >= 63.0 else "second"),
        "states_of_exponent": sweep(lambda a, z: "chaos" if a >= 58.0 else "second"),
    }
    finding = about_chaos.predicted_onset(**tables)
    assert (numbers(finding.euler), numbers(finding.converged)) == ((1.0, 4.0), (1.0, 1.0))
    assert "1.00 to 2.00 in the second state and 2.00 to 2.00 in chaos" in finding.note
    assert "no known dimension at 1 of 71 amplitudes (interval too wide: 1)" in finding.note
    assert "begins at 63 m/s² for the one of Fig. 24, and at 58 m/s² for the one of Fig. 22" in finding.note
    assert "dimension shows 62 m/s², and the converged estimate of Fig. 22 59 m/s²" in finding.note


def test_the_onset_by_dimension_is_half_way_between_both_ends():
    """From 1 to 2 the dimension is nearer to its upper end from 1.5 on."""
    amplitudes = np.arange(30.0, 90.0)
    table = pd.DataFrame({"acceleration": amplitudes, "dimension": np.interp(amplitudes, [50.0, 70.0], [1.0, 2.0])})
    assert about_chaos.dimension_onset(table) == 61.0


def test_the_page_explains_verdicts_and_has_dashes_for_missing_numbers():
    template = (ROOT / "workflow/rules/paper/claims.md").read_text(encoding="utf-8")
    claim = {"where": "3.1", "statement": "", "quantities": quantities(onset=[1.0, 2.0])}
    claim["quantities"]["onset"]["because"] = "why"
    found = Finding({}, {"onset": 9.0}, "A note")
    table = pd.DataFrame(verdicts.columns({"C1": claim}, {"C1": found}))
    page = verdicts.report(template, table)
    assert "| – | 9 | [1, 2] (why) | **not reproduced** |" in page
    assert (
        "## Why statements are not reproduced\n\n- **C1** onset: 9 by the converged solution; accepted: [1, 2]." in page
    )
    assert "## Notes" not in page  # no heading without a text below it
