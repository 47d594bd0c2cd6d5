"""The claim that the transit of parts decides."""

import numpy as np
import pandas as pd
import pytest

from conveyor_pipeline.machine.claims import about_transit


def test_where_chaos_depends_on_the_initial_condition():
    regimes = pd.DataFrame(
        {
            "regime": ["one velocity", "chaos beside other motions", "chaos only", "chaos beside other motions"],
            "begin": [20.0, 53.0, 60.0, 73.0],
            "end": [52.0, 53.5, 72.0, 73.0],
        }
    )
    expected = "At 53 to 53.5, 73 m/s², chaos exists beside other motions, and the initial condition decides"
    assert about_transit.describe_regimes(regimes) == expected
    assert about_transit.describe_regimes(regimes[:3]).startswith(
        "At all computed amplitudes from 60 m/s² on, all motions are chaotic. At 53"
    )


def test_amplitudes_beyond_the_axes_of_the_paper_s_figures_do_not_decide():
    lengths = pd.DataFrame(
        {
            "acceleration": np.repeat([40.0, 80.0, 120.0], 3),
            "regime": np.repeat(["several velocities", "chaos only", "chaos only"], 3),
            "length": np.tile([0.25, 0.5, 1.0], 3),
        }
    )
    lengths["spread"] = lengths.length ** np.repeat([0.0, -0.5, -0.2], 3)
    drift = pd.DataFrame({"acceleration": [80.0, 120.0], "velocity_1": 0.1, "velocity_2": [0.1, 0.2]})
    drift = drift.assign(velocity_1_stderr=0.001, velocity_2_stderr=0.001)
    regimes = pd.DataFrame({"regime": ["chaos only"], "begin": [75.0], "end": [150.0]})
    finding = about_transit.even_feeding(drift=drift, lengths=lengths, regimes=regimes)
    _, numbers, note = finding
    assert numbers["sets"] == 0.0
    assert numbers["exponent"] == pytest.approx(-0.5)
    assert numbers["coexisting"] == pytest.approx(0.0)
    assert "chaos at larger amplitudes, which do not decide, at 120 m/s² (-0.20)" in note
    assert "velocities are compared at 80 m/s²." in note
