"""Tests of results that the pipeline has made, not of its code: `snakemake` runs them as its rule check_results."""

import pandas as pd
import pytest

from made import RESULTS


@pytest.fixture(scope="session")
def result():
    """A function that reads a table of the results."""
    return lambda name: pd.read_parquet(RESULTS / f"{name}.parquet")
