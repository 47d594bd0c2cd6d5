"""Eq. 13 fitted to heights that lie on it."""

import numpy as np
import pandas as pd
import pytest

from conveyor_pipeline.paper.fit import regressions

TRUE = {"A": 0.004, "B": -20.0, "C": -1.2e-4}  # m²/s², m/s², m
SETTINGS = {
    "acceleration": [29.0, 47.0],
    "bounds": {"A": [0.0, 0.03], "B": [-28.0, 0.0], "C": [-1e-3, 1e-3]},
    "valley": {"start": -22.0, "stop": -18.0, "num": 5},
    "paper": {"A": 0.004116, "B": -19.54145, "C": -0.0001354},
}


def made(settings: dict = SETTINGS) -> pd.DataFrame:
    """The table of fits to these heights."""
    return pd.DataFrame(regressions.make(heights(), settings))


def heights() -> pd.DataFrame:
    """Critical heights on the curve; heights that are not critical, or at amplitudes that are not used, lie off it."""
    acceleration = np.linspace(25.0, 50.0, 51)
    height = TRUE["A"] / (TRUE["B"] + acceleration) + TRUE["C"]
    on_curve = pd.DataFrame({"acceleration": acceleration, "z0": height, "is_critical": True})
    on_curve.loc[~on_curve.acceleration.between(*SETTINGS["acceleration"]), "z0"] = 1.0
    others = on_curve.assign(z0=1.0, is_critical=False)
    return pd.concat([on_curve, others])


def test_both_fits_find_the_curve():
    table = made().set_index("fit")
    for fit in ("least_squares", "pymoo"):
        assert table.loc[fit, ["A", "B", "C"]].to_numpy(float) == pytest.approx(list(TRUE.values()), rel=1e-4)
        assert table.loc[fit, "error"] < 1e-16  # m²


def test_the_valley_has_its_bottom_at_the_true_parameter():
    valley = made().query("fit == 'valley'")
    assert valley.B.tolist() == pytest.approx([-22.0, -21.0, -20.0, -19.0, -18.0])
    assert valley.error.idxmin() == valley.index[2]
    assert valley.error.iloc[2] < 1e-20


def test_too_few_heights_are_not_fitted():
    fitted = heights().query("29 <= acceleration <= 47")
    assert pd.DataFrame(regressions.make(fitted.head(3), SETTINGS)).empty
    assert pd.DataFrame(regressions.make(fitted.head(0), SETTINGS)).empty
