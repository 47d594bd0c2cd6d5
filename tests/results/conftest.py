"""Results of the pipeline to be tested: those of the paper, or those below the folder that CONVEYOR_RESULTS names."""

import os
from pathlib import Path

import pandas as pd
import pytest

RESULTS = Path(os.environ.get("CONVEYOR_RESULTS", Path(__file__).resolve().parents[2] / "results"))


@pytest.fixture(scope="session")
def result():
    """A function that reads a table of the results; the test is skipped if that has not been made."""

    def read(name: str) -> pd.DataFrame:
        path = RESULTS / f"{name}.parquet"
        if not path.is_file():
            pytest.skip(f"{path} has not been made")
        return pd.read_parquet(path)

    return read
