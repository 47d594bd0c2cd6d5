"""Parameters from measured velocities: their posterior, and whether the model explains the measurements."""

import numpy as np

from calibration.effort import sizes_of
from calibration.inference import (
    DETERMINED,
    DISAGREEING,
    NOT_DETERMINED,
    OPEN,
    TOO_FEW,
    data_of,
    draw,
    search,
    summarize_parameters,
)
from calibration.measurements import CALIBRATED, EXAMPLE, HEADER_UNITS, Measurement, parse, wanted
from calibration.model_check import check_fit, compare_alternatives
from calibration.search_space import values_at
from conveyor import RANGES, UNITS
from pipeline import csv_table, fields

TABLES = {
    "parameters": (
        fields.text("parameter", "parameter of the model"),
        fields.text("unit", "its unit"),
        fields.number("best", "SI", "value at the medians of the posterior"),
        fields.number("best_error", "SI", "Monte Carlo error of it: standard error by the jackknife over the searches"),
        fields.number("low", "SI", "lower end of the 95 % interval; null if the sample is too small for intervals"),
        fields.number("low_error", "SI", "Monte Carlo error of it"),
        fields.number("high", "SI", "upper end of the 95 % interval; null if the sample is too small for intervals"),
        fields.number("high_error", "SI", "Monte Carlo error of it"),
        fields.number("range_low", "SI", "lower end of the searched range; of the damping, for the best stiffness"),
        fields.number("range_high", "SI", "upper end of the searched range; of the damping, for the best stiffness"),
        fields.text("status", f"{DETERMINED}, {OPEN}, {NOT_DETERMINED}, {DISAGREEING}, or {TOO_FEW}"),
        fields.number("effective", "1", "effective number of samples of the posterior"),
        fields.count("searches", "independent searches"),
    ),
    "samples": (
        *(fields.number(name, UNITS[name], "value in this sample of the posterior") for name in CALIBRATED),
        fields.number("log_likelihood", "1", "logarithm of the likelihood"),
    ),
    "fit": (
        fields.count("line", "line of the file of measurements"),
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.number("velocity", "m/s", "measured velocity"),
        fields.flag("changed", "whether this line gives the conveyor another parameter than the config"),
        fields.number("sd", "m/s", "standard deviation of the measurement"),
        fields.number("low", "m/s", "5 % quantile of what the best parameters give, noise included"),
        fields.number("median", "m/s", "median of what the best parameters give"),
        fields.number("high", "m/s", "95 % quantile of what the best parameters give, noise included"),
        fields.number("p_row", "1", "share of replicates of this measurement that fit worse, for the best parameters"),
        fields.flag("fits", "whether this share is not small"),
        fields.number(
            "p_value",
            "1",
            "share of replicates of all measurements that fit worse, mean over the posterior; equal in all rows",
        ),
        fields.flag(
            "explained",
            "whether the model explains the measurements, and no alternative is preferred; equal in all rows",
        ),
    ),
    "alternatives": (
        fields.text("parameter", "parameter of the model that was searched in addition"),
        fields.text("unit", "its unit"),
        fields.number("value", "SI", "value at the medians of this posterior"),
        fields.number(
            "log_bayes_factor", "1", "logarithm of how much more probable the measurements are with this parameter"
        ),
        fields.flag("preferred", "whether the measurements demand this parameter"),
        fields.number("effective", "1", "effective number of samples of this posterior"),
    ),
}


def calibrate(
    measured: list[Measurement], settings: dict, *, threads: int = 1, progress: str | None = None
) -> dict[str, dict]:
    """The columns of the tables of parameters, of samples, of the fit and of alternatives, from measurements."""
    data = data_of(measured, settings["model"])
    options = {"threads": threads, "progress": progress}
    posterior = search(data, settings, **options)
    alternatives = compare_alternatives(posterior, data, settings, **options)
    fit = check_fit(posterior, data, settings, **options)
    fit["explained"] &= not any(row["preferred"] for row in alternatives)
    chosen = draw(posterior, settings["samples"])
    values = values_at(posterior.points[chosen], settings)
    others = {name: np.full(len(chosen), value) for name, value in settings["model"].items() if name in CALIBRATED}
    return {
        "parameters": fields.columns(summarize_parameters(posterior, settings), TABLES["parameters"]),
        "samples": {**others, **values, "log_likelihood": posterior.log_density[chosen]},
        "fit": fit,
        "alternatives": fields.columns(alternatives, TABLES["alternatives"]),
    }


def make(measurements: str, settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, dict]:
    """The tables from the text of the file of measurements."""
    table = csv_table.parse(measurements, settings["measurements"], wanted(RANGES), HEADER_UNITS, EXAMPLE)
    measured = parse(table, settings, RANGES)
    settings = settings | sizes_of(settings["effort"])
    return calibrate(measured, settings, threads=threads, progress=progress)
