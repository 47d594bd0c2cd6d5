"""The page that compares the solver at its default tolerance with the paper's method, from the tables of precision."""

import pandas as pd

from conveyor_pipeline.common.templates import render
from conveyor_pipeline.study.accuracy import speed
from conveyor_pipeline.study.accuracy.scenes import SCENES, TRUTH


def make(template: str, **tables: pd.DataFrame) -> str:
    """The page from its template.

    tables : errors and times of each scene, by the names SCENE and SCENE_times
    """
    rows = [speed.at_default(scene, tables[scene], tables[f"{scene}_times"]) for scene in SCENES]
    difference = max(speed.independent_run(tables[scene]).velocity_error for scene in SCENES)
    return render(template, {"rows": rows, "tolerance_of_truth": TRUTH, "difference": difference})
