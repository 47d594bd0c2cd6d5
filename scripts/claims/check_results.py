"""Run the tests of the results, tests/results, in a separate process."""

import json
import os
import re
import subprocess
import sys


def make(results: str, figures: dict, tests: str) -> str:
    """The number of passed tests, in pytest's words.

    Parameters
    ----------
    results : folder of the results
    figures : the section `figures` of the config
    tests : folder of the tests

    Raises
    ------
    RuntimeError
        with pytest's output, if a test fails
    """
    environment = {"CONVEYOR_RESULTS": results, "CONVEYOR_FIGURES": json.dumps(figures)}
    run = subprocess.run(
        # The interpreter of this process: PATH may have another one, or none.
        [sys.executable, "-m", "pytest", tests, "--dist=worksteal"],
        env={**os.environ, **environment},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    if run.returncode != 0:
        raise RuntimeError(f"tests of the results fail:\n{run.stdout}")
    return re.search(r"\d+ passed", run.stdout).group() + "\n"
