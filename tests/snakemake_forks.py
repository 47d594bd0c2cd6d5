"""Snakemake for tests: imported once, after which each command runs in a fork of this process.

Importing Snakemake takes most of the processor time of a dry run, and importing packages most of the time of a small
job that runs in Snakemake's process. Each line of standard input is a command in JSON; each line of standard output is
its exit status.
"""

import gc
import importlib
import json
import os
import sys

import numba
from snakemake.cli import main, parse_args

# Snakemake imports the first two when a command needs them, and jobs import the others.
LATE = ("nbformat", "smart_open", "matplotlib.backends.backend_agg", "matplotlib.backends.backend_pdf")
LATE += ("matplotlib.pyplot", "pandas", "pyarrow.parquet", "scipy.integrate", "scipy.optimize")


def run(arguments: list[str], folder: str, environment: dict[str, str], output: str) -> int:
    """Run Snakemake as a new process would in a folder, write what it prints to a file, and return its exit status."""
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    sys.path[0] = folder
    sys.argv[1:] = arguments
    with open(output, "wb") as file, open(os.devnull, "rb") as nothing:
        os.dup2(nothing.fileno(), 0)
        for descriptor in (1, 2):
            os.dup2(file.fileno(), descriptor)
    try:
        main(arguments)
    except SystemExit as end:
        sys.stdout.flush()
        return end.code


parse_args([])  # imports the plugins
for name in LATE:
    importlib.import_module(name)
numba.njit(lambda: 0)()  # imports the rest of numba
# A fork copies the memory that it writes to: neither its garbage collector nor its end may touch what it shares.
gc.freeze()
for line in sys.stdin:
    child = os.fork()
    if child == 0:
        os._exit(run(**json.loads(line)))
    _, status = os.waitpid(child, 0)
    print(os.waitstatus_to_exitcode(status), flush=True)
