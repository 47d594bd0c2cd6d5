"""Tests of results that the pipeline has made, not of its code: `snakemake` runs them as its rule check_results.

They look into the folder that CONVEYOR_RESULTS names, else into the paper's results, and fail for want of a table.
"""

import os
from pathlib import Path

import pandas as pd
import pytest

RESULTS = Path(os.environ.get("CONVEYOR_RESULTS", Path(__file__).resolve().parents[2] / "results"))


@pytest.fixture(scope="session")
def result():
    """A function that reads a table of the results."""
    return lambda name: pd.read_parquet(RESULTS / f"{name}.parquet")
