"""The log of a rule: the stderr of its script, and the traceback if it fails."""

import atexit
import gc
import importlib.util
import os
import sys
import traceback
from collections.abc import Iterator
from contextlib import closing, contextmanager
from typing import TextIO

from conveyor_pipeline.common.code_state import SCRIPTS, STATE, code_state

COMPILED = "Time to compile: "  # a line in the log of a job that compiled functions
# Otherwise Python would search all objects for cycles at its end, which takes 0.2 s per job.
atexit.register(gc.freeze)


class JobError(Exception):
    """A job cannot be done as the config or its files demand; the message says why, and what the user can do."""


class Tee:
    """A text stream that writes to a terminal and to a log; the log gets only the final state of a progress bar."""

    def __init__(self, terminal: TextIO, log: TextIO):
        self.terminal, self.log = terminal, log
        self.line = ""

    def isatty(self) -> bool:
        return self.terminal.isatty()

    def write(self, text: str) -> int:
        self.terminal.write(text)
        *lines, self.line = (self.line + text).split("\n")
        self.log.writelines(f"{visible_text(line)}\n" for line in lines)
        return len(text)

    def flush(self) -> None:
        self.terminal.flush()
        self.log.flush()

    def close(self) -> None:
        """Write an unfinished line to the log; the terminal stays open."""
        self.log.write(visible_text(self.line))


def check_imports() -> None:
    """Check that the packages of this project come from the folder whose code the rules hash.

    Raises
    ------
    JobError
        names the folder and a package that was imported from elsewhere; its tables would be taken for up to date
    """
    for package in sorted(path.parent for path in SCRIPTS.glob("*/__init__.py")):
        if (origin := importlib.util.find_spec(package.name).origin) != str(package / "__init__.py"):
            raise JobError(
                f"this job would run {origin}, but the rules hash {package}; uninstall the package {package.name}, or "
                "remove its folder from PYTHONPATH"
            )


def check_code(hashed: str) -> None:
    """Check that the code of a job is still the one that the Snakefile hashed: its param `code`.

    Raises
    ------
    JobError
        the table would be taken for one of the earlier code, also after the change is undone
    """
    if os.environ.get(STATE) == code_state():
        return
    from conveyor_pipeline.common.source_hash import code_of

    if code_of(*hashed.split()[1:]) != hashed:
        raise JobError("the code of this job was changed after Snakemake had read it; run Snakemake again")


def visible_text(line: str) -> str:
    """The text that a terminal finally shows of a line, after its last carriage return."""
    return line.rpartition("\r")[2]


@contextmanager
def logged(path: str) -> Iterator[None]:
    """Copy stderr (progress, warnings) to the file `path`, and write the traceback of an exception to it.

    A JobError ends the script with its message alone, because a traceback tells a user nothing.
    """
    terminal = sys.stderr
    with open(path, "w", encoding="utf-8") as log, closing(Tee(terminal, log)) as tee:
        sys.stderr = tee
        try:
            check_imports()
            yield
        except JobError as error:
            print(error, file=tee.log)
            sys.exit(str(error))
        except BaseException:
            traceback.print_exc(file=tee.log)
            raise
        finally:
            sys.stderr = terminal
