"""The claim that the transit of parts decides."""

import pandas as pd

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
    assert about_transit.describe_regimes(regimes[:3]).startswith("From 60 m/s² on, all motions are chaotic. At 53")
