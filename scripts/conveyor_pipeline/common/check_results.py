"""Run the tests of the results, tests/results, in a separate process."""

import json
import os
import re
import subprocess
import sys


def make(results: str, figures: dict, tests: str, *, threads: int = 1) -> str:
    """The number of passed tests, in pytest's words, of the folder `tests` on the folder `results`.

    Raises
    ------
    RuntimeError
        with pytest's output, if a test fails
    """
    environment = os.environ | {"CONVEYOR_RESULTS": results, "CONVEYOR_FIGURES": json.dumps(figures)}
    # The interpreter of this process: PATH may have another one, or none.
    command = [sys.executable, "-m", "pytest", tests, f"--numprocesses={threads}", "--dist=worksteal"]
    run = subprocess.run(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
    )
    if run.returncode != 0:
        raise RuntimeError(f"tests of the results fail:\n{run.stdout}")
    return re.search(r"\d+ passed", run.stdout).group() + "\n"
