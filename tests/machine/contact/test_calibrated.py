"""A calibration replaces what materials and a drop say."""

import pandas as pd
import yaml
from project import merged, read_config

from conveyor_pipeline.config import canonical, problems
from conveyor_pipeline.machine.calibration import overlay


def test_calibrated_values_take_the_place_of_the_section_contact():
    rows = [
        {"parameter": name, "best": best, "low": best, "high": best}
        for name, best in (("friction", 0.2), ("damping", 1.5), ("stiffness", 1.2e6))
    ]
    parameters = pd.DataFrame(rows).assign(unit="SI", status="determined")
    parameters.attrs = {"measurements": "mine.csv", "effort": 1.0}
    calibrated = yaml.safe_load(overlay.make(parameters, pd.DataFrame({"explained": [True]})))
    del calibrated["parts"]  # needs a file of measurements
    contact = {"part": "steel", "lining": "PP", "radius": "2 mm", "restitution": 0.6}
    stated = merged({"prefix": "mine", "contact": contact}, calibrated)
    assert problems(merged(read_config(), stated), stated=stated) == []
    model = canonical(merged(read_config(), stated))["model"]
    assert (model["damping"], model["stiffness"], model["friction"]) == (1.5, 1.2e6, 0.2)
