"""The page of all tables: columns, units and meanings, from the schemas of the stages."""

from collections.abc import Sequence
from types import ModuleType

import pyarrow as pa

from accuracy import (
    benchmark,
    map_check,
    precision,
    precision_estimates,
    reference_check,
    rigid_part,
    scaling,
    scene_budget,
    settling_times,
    stability,
    stability_estimates,
    theory,
)
from claims import verdicts
from dimensions import portraits
from fit import regressions
from identification import edges, fronts, printed, profiles
from motion import critical, impacts, signals, spectra
from operating import advice, drive, shares, throws, track
from orbits import branches, certified, estimates, exponents, strobes, witnesses
from pipeline import fields
from pipeline.templates import render
from sensitivity import curves, derivatives
from sweeps import shards
from workflow.config.tables import TABLES

# All modules that make tables, in the order of the stages.
MODULES = (
    shards,
    signals,
    spectra,
    impacts,
    critical,
    branches,
    strobes,
    exponents,
    estimates,
    witnesses,
    certified,
    portraits,
    regressions,
    derivatives,
    curves,
    shares,
    advice,
    throws,
    track,
    drive,
    benchmark,
    precision,
    reference_check,
    precision_estimates,
    stability,
    stability_estimates,
    scene_budget,
    rigid_part,
    theory,
    map_check,
    settling_times,
    scaling,
    verdicts,
    edges,
    printed,
    fronts,
    profiles,
)


def file_of(kind: str) -> str:
    """The file of the tables of a kind; NAME stands for the name of an entry of the config."""
    folders = [reference.split("/")[0] for reference in TABLES if reference.split("/")[1] == kind]
    if not folders:
        return f"results/{kind}/NAME.parquet"
    return f"results/{kind}.parquet" if folders == ["results"] else f"results/{folders[0]}/{kind}.parquet"


def describe(column: pa.Field) -> dict[str, str]:
    """Name, unit and meaning of a column."""
    unit, meaning = (column.metadata[key].decode() for key in (b"unit", b"description"))
    is_list = pa.types.is_list(column.type)
    return {"name": column.name, "unit": unit, "meaning": f"list: {meaning}" if is_list else meaning}


def tables_of_stages(modules: Sequence[ModuleType]) -> dict[str, list[dict]]:
    """Files and columns of all tables, by stage."""
    found = {}
    for module in modules:
        tables = found.setdefault(module.__name__.split(".")[0], [])
        tables += [
            {"kind": kind, "file": file_of(kind), "columns": [describe(column) for column in schema]}
            for kind, schema in module.TABLES.items()
        ]
    return found


def make(template: str) -> str:
    """The page from its template."""
    axes = [describe(column) for column in fields.AXES.values()]
    return render(template, {"stages": tables_of_stages(MODULES), "axes": axes})
