"""The table of the simulation study: a row for each data set."""

import json
import math

from calibration.model_check import DECISIVE, SIGNIFICANCE
from calibration.study import PARAMETERS
from pipeline import fields

TABLES = {
    "calibration_study": (
        fields.count("number", "number of the data set, the seed of its random numbers"),
        fields.text("kind", "rich, poor, or what was wrong"),
        fields.number("frequency", "Hz", "frequency of the excitation"),
        fields.number("angle", "rad", "angle of throw"),
        fields.number("mass", "kg", "mass of the part"),
        fields.count("measurements", "number of measured velocities"),
        *(
            fields.number(f"{name}{ending}", "SI", f"{name}: {meaning}")
            for name in PARAMETERS
            for ending, meaning in (
                ("", "true value"),
                ("_best", "best value"),
                ("_low", "lower end of the interval"),
                ("_high", "upper end of the interval"),
            )
        ),
        fields.number("in_band", "1", "share of further velocities within the predicted band from 5 % to 95 %"),
        fields.number("p_value", "1", "of the data under the model"),
        fields.text("alternative", "parameter that explains the data best if it is searched, too"),
        fields.number("log_bayes_factor", "1", "logarithm of its Bayes factor"),
        fields.flag("explained", "whether the model is said to explain the data"),
        fields.number("effective", "1", "effective number of samples"),
        fields.number(
            "gain_of_distant",
            "1",
            "largest logarithm of the likelihood, from many parts, of samples whose friction or damping differs from "
            "the best by more than 20 %, minus that of the true parameters; null for none, and for wrong models",
        ),
        fields.number(
            "gain_of_truth",
            "1",
            "logarithm of the evidence of the true model minus that of the assumed one; null for right models",
        ),
    )
}


def make(rows: list[str]) -> dict[str, list]:
    """The columns of the table from the rows of all data sets, as JSON."""
    parsed = [json.loads(row) for row in rows]
    for row in parsed:
        row |= {name: row.get(name) for name in ("gain_of_distant", "gain_of_truth")}
        row["explained"] = row["p_value"] >= SIGNIFICANCE and row["log_bayes_factor"] <= math.log(DECISIVE)
    return fields.columns(parsed, TABLES["calibration_study"])
