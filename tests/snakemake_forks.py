"""Snakemake for tests: imported once, after which each command runs in a fork of this process.

Importing Snakemake takes two thirds of the processor time of a dry run. Each line of standard input is a command in
JSON; each line of standard output is its exit status.
"""

import json
import os
import sys

# Snakemake imports some packages when a command needs them.
import nbformat  # noqa: F401
import smart_open  # noqa: F401
from snakemake.cli import main


def run(arguments: list[str], folder: str, environment: dict[str, str], output: str) -> None:
    """Run Snakemake as a new process would in a folder, and write what it prints to the file `output`."""
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    sys.path[0] = folder
    sys.argv[1:] = arguments
    with open(output, "wb") as file, open(os.devnull, "rb") as nothing:
        os.dup2(nothing.fileno(), 0)
        for descriptor in (1, 2):
            os.dup2(file.fileno(), descriptor)
    main(arguments)


for line in sys.stdin:
    child = os.fork()
    if child == 0:
        run(**json.loads(line))
    _, status = os.waitpid(child, 0)
    print(os.waitstatus_to_exitcode(status), flush=True)
