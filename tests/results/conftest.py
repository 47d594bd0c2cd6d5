"""Results of the pipeline to be tested: those below the folder that CONVEYOR_RESULTS names, all of which must be there,
or else what has been made of the paper's.
"""

import os
from pathlib import Path

import pandas as pd
import pytest

NAMED = os.environ.get("CONVEYOR_RESULTS")
RESULTS = Path(NAMED or Path(__file__).resolve().parents[2] / "results")


@pytest.fixture(scope="session")
def result():
    """A function that reads a table of the results; if that has not been made, the test is skipped, or fails if the
    results have been named: then nothing may pass for want of a table.
    """

    def read(name: str) -> pd.DataFrame:
        path = RESULTS / f"{name}.parquet"
        if not path.is_file():
            (pytest.fail if NAMED else pytest.skip)(f"{path} has not been made")
        return pd.read_parquet(path)

    return read
