"""Parameters from measured velocities: their posterior, and whether the model explains the measurements."""

import numpy as np

from conveyor import UNITS
from conveyor.progress import progress_bar
from conveyor_pipeline.common import csv_table, fields
from conveyor_pipeline.machine.calibration.effort import SEARCHES, sizes_of
from conveyor_pipeline.machine.calibration.inference import (
    DETERMINED,
    NOT_CONVERGED,
    NOT_DETERMINED,
    OPEN,
    data_of,
    draw,
    has_converged,
    runs_of_search,
    search,
    summarize_parameters,
)
from conveyor_pipeline.machine.calibration.measurements import (
    CALIBRATED,
    EXAMPLE,
    HEADER_UNITS,
    Measurement,
    parse,
    wanted,
)
from conveyor_pipeline.machine.calibration.model_check import (
    check_fit,
    compare_alternatives,
    measured_columns,
    runs_of_check,
    settings_of_alternatives,
)
from conveyor_pipeline.machine.calibration.search_space import values_at

TABLES = {
    "parameters": (
        fields.text("parameter", "parameter of the model"),
        fields.text("unit", "its unit"),
        fields.number("best", "SI", "value at the medians of the posterior; null if the search has not converged"),
        fields.number("best_error", "SI", "Monte Carlo error of it: standard error by the jackknife over the searches"),
        fields.number("low", "SI", "lower end of the 95 % interval; null if the search has not converged"),
        fields.number("low_error", "SI", "Monte Carlo error of it"),
        fields.number("high", "SI", "upper end of the 95 % interval; null if the search has not converged"),
        fields.number("high_error", "SI", "Monte Carlo error of it"),
        fields.number("range_low", "SI", "lower end of the searched range; of the damping, for the best stiffness"),
        fields.number("range_high", "SI", "upper end of the searched range; of the damping, for the best stiffness"),
        fields.text("status", f"{DETERMINED}, {OPEN}, {NOT_DETERMINED}, or {NOT_CONVERGED}"),
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
            "share of replicates of all measurements that fit worse, mean over the posterior; equal in all rows; null, "
            "like the other columns about the fit, if the search has not converged",
        ),
        fields.flag(
            "explained",
            "whether the model explains the measurements, and no alternative is preferred; equal in all rows",
        ),
    ),
    "alternatives": (
        fields.text("parameter", "parameter of the model that was searched in addition"),
        fields.text("unit", "its unit"),
        fields.number("value", "SI", "value at the medians of this posterior; null if this search has not converged"),
        fields.number(
            "log_bayes_factor",
            "1",
            "logarithm of how much more probable the measurements are with this parameter; null if not converged",
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
    searches = SEARCHES + len(settings_of_alternatives(data, settings))
    runs = searches * runs_of_search(data, settings) + runs_of_check(data, settings)
    with progress_bar(total=runs, label=progress, unit="runs") as bar:
        posterior = search(data, settings, threads=threads, bar=bar)
        converged = has_converged(posterior, settings)
        if converged:
            alternatives = compare_alternatives(posterior, data, settings, threads=threads, bar=bar)
            fit = check_fit(posterior, data, settings, threads=threads)
            fit["explained"] &= not any(row["preferred"] for row in alternatives)
            bar.update(runs_of_check(data, settings))
        else:
            bar.total = bar.n
            alternatives = []
            fit = {column.name: [None] * len(measured) for column in TABLES["fit"]} | measured_columns(data, settings)
    chosen = draw(posterior, settings["samples"] if converged else 0)
    values = values_at(posterior.points[chosen], settings)
    fixed = {name: np.full(len(chosen), value) for name, value in settings["model"].items() if name in CALIBRATED}
    return {
        "parameters": fields.columns(summarize_parameters(posterior, settings), TABLES["parameters"]),
        "samples": {**fixed, **values, "log_likelihood": posterior.log_density[chosen]},
        "fit": fit,
        "alternatives": fields.columns(alternatives, TABLES["alternatives"]),
    }


def make(measurements: str, settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, dict]:
    """The tables from the text of the file of measurements."""
    table = csv_table.parse(measurements, settings["measurements"], wanted, HEADER_UNITS, EXAMPLE)
    measured = parse(table, settings)
    settings = settings | sizes_of(settings["effort"])
    return calibrate(measured, settings, threads=threads, progress=progress)
