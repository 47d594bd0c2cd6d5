"""Tests of the results of the pipeline, not of its code; the rule check_results runs them."""

import pytest

from conveyor_pipeline.common import tables
from conveyor_pipeline.config.tables import kind_of
from made import RESULTS


@pytest.fixture(scope="session")
def result():
    """A function that reads a table of the results."""

    def read(name: str):
        return tables.read(RESULTS / f"{name}.parquet", kind_of(name if "/" in name else f"results/{name}"))

    return read
