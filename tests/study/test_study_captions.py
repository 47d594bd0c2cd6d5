"""Captions of the floor study."""

import numpy as np
import pandas as pd
from filled_captions import caption


def test_tables_with_a_visible_variant_count_once():
    names = ("sweeps/a", "sweeps/a", "sweeps/b")
    table = pd.DataFrame({"table": names, "variant": "rigid part", "tolerance": np.nan, "visible": [True, True, False]})
    half = table.assign(variant="half the time", visible=False)
    text = caption("scene_budget", budget=pd.concat([table, half]))
    assert "visible in 1 of 2 tables, half the time in 0 of 2." in text
