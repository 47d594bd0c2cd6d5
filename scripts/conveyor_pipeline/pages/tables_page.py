"""The page of all tables: columns, units and meanings, from the schemas of the stages."""

import importlib
import pkgutil
from collections.abc import Collection
from types import ModuleType

import pyarrow as pa

from conveyor_pipeline.common import fields
from conveyor_pipeline.common.templates import render
from conveyor_pipeline.config.stages import STAGES
from conveyor_pipeline.config.tables import NAMED, TABLES


def modules_of(package: str) -> list[ModuleType]:
    """The modules of a stage that make tables, in the order of their names."""
    names = [module.name for module in pkgutil.iter_modules(importlib.import_module(package).__path__)]
    modules = [importlib.import_module(f"{package}.{name}") for name in names]
    return [module for module in modules if hasattr(module, "TABLES")]


def file_of(kind: str, kinds: Collection[str], stage: str) -> str:
    """The file of the tables of a kind; NAME stands for the name of an entry of the config.

    kinds : of all tables of the module, which tell folders with tables of the same name apart
    """
    if kind in NAMED:
        return f"results/{kind}/NAME.parquet"
    folders = [reference.split("/")[0] for reference in TABLES if reference.split("/")[1] == kind] or [stage]
    folder = next((place for place in folders if all(f"{place}/{name}" in TABLES for name in kinds)), folders[0])
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
            {
                "kind": kind,
                "file": file_of(kind, module.TABLES, stage),
                "columns": [describe(column) for column in schema],
            }
            for module in modules_of(package)
            for kind, schema in module.TABLES.items()
        ]
        for stage, package in STAGES.items()
    }
    axes = [describe(column) for column in fields.AXES.values()]
    return render(template, {"stages": stages, "axes": axes})
