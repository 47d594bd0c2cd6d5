"""The page of all tables: columns, units and meanings, from the schemas of the stages."""

import pyarrow as pa

from accuracy import (
    benchmark,
    map_check,
    precision,
    reference_check,
    rigid_part,
    scene_budget,
    settling_times,
    stability,
    stability_estimates,
    theory,
)
from calibration import calibrate, prediction, study_table
from claims import verdicts
from dimensions import portraits
from excitation import clean_drive, comparison, measure
from fit import regressions
from identification import edges, posterior
from motion import critical, impacts, signals, spectra
from operating import advice, drift, drive, shares, throws, track, transit
from orbits import branches, certified, estimates, exponents, strobes, witnesses
from pipeline import fields
from pipeline.templates import render
from sensitivity import curves, derivatives
from sweeps import shards
from workflow.config.tables import TABLES

# All modules that make tables, by stage.
MODULES = {
    "sweeps": [shards],
    "motion": [signals, spectra, impacts, critical],
    "orbits": [branches, strobes, exponents, estimates, witnesses, certified],
    "dimensions": [portraits],
    "fit": [regressions],
    "sensitivity": [derivatives, curves],
    "operating": [shares, transit, drift, advice, throws, track, drive],
    "excitation": [measure, comparison, clean_drive],
    "calibration": [calibrate, prediction, study_table],
    "accuracy": [
        *(benchmark, precision, reference_check, stability, stability_estimates),
        *(scene_budget, rigid_part, theory, map_check, settling_times),
    ],
    "claims": [verdicts],
    "identification": [edges, posterior],
}


def file_of(kind: str, stage: str = "") -> str:
    """The file of the tables of a kind; NAME stands for the name of an entry of the config.

    stage : which of several stages makes the table, if tables of the same name exist
    """
    folders = [reference.split("/")[0] for reference in TABLES if reference.split("/")[1] == kind]
    if not folders:
        return f"results/{kind}/NAME.parquet"
    folder = stage if stage in folders else folders[0]
    return f"results/{kind}.parquet" if folder == "results" else f"results/{folder}/{kind}.parquet"


def describe(column: pa.Field) -> dict[str, str]:
    """Name, unit and meaning of a column."""
    unit, meaning = (column.metadata[key].decode() for key in (b"unit", b"description"))
    is_list = pa.types.is_list(column.type)
    return {"name": column.name, "unit": unit, "meaning": f"list: {meaning}" if is_list else meaning}


def make(template: str) -> str:
    """The page from its template."""
    stages = {
        stage: [
            {"kind": kind, "file": file_of(kind, stage), "columns": [describe(column) for column in schema]}
            for module in modules
            for kind, schema in module.TABLES.items()
        ]
        for stage, modules in MODULES.items()
    }
    axes = [describe(column) for column in fields.AXES.values()]
    return render(template, {"stages": stages, "axes": axes})
