"""What numba compiles in a session: said once, and timed."""

import os
import subprocess
import sys

import pytest
from project import ROOT

from conveyor.solver.compilation import NOTICE

# A root of 1 - 2 s, by several functions, so that a notice for each would be seen.
ROOT_OF_LINE = """
import numpy as np
from conveyor.solver import polynomial
from conveyor.solver.compilation import compile_seconds

series = np.zeros(polynomial.SIZE)
series[:2] = 1.0, -2.0
print(polynomial.first_root(series, polynomial.FIRST_ROW, 0.0, 1.0, polynomial.LEAVE))
print(compile_seconds())
"""
OTHER = """
import numba
from conveyor.solver import jit

print(numba.njit(lambda number: number + 1)(1))
"""


@pytest.fixture
def run(tmp_path):
    """A function that runs code in a new session with a cache that is empty at first."""

    def in_session(code, **variables):
        environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path), "PYTHONPATH": str(ROOT / "scripts")} | variables
        environment.pop("NUMBA_CACHE_DIR", None)
        command = [sys.executable, "-W", "ignore", "-c", code]
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=True)

    return in_session


def test_the_notice_comes_once_and_not_from_the_cache(run):
    first, later = run(ROOT_OF_LINE), run(ROOT_OF_LINE)
    assert first.stderr == f"{NOTICE}\n"
    assert float(first.stdout.split()[-1]) > 0.0
    assert later.stderr == ""
    assert float(later.stdout.split()[-1]) == 0.0


def test_the_notice_and_the_time_are_in_the_log_of_a_rule(run, tmp_path):
    code = f"from conveyor_pipeline.common.rule_log import logged\nwith logged('{tmp_path}/rule.log'):\n"
    run(code + ROOT_OF_LINE.replace("\n", "\n    "))
    assert (tmp_path / "rule.log").read_text() == f"{NOTICE}\n"


@pytest.mark.parametrize("switch", ["enable", "disable"])
def test_functions_of_others_give_no_notice_and_the_garbage_collector_is_left_as_it_was(run, switch):
    found = run(f"import gc\ngc.{switch}(){OTHER}print(gc.isenabled())")
    assert found.stdout.split()[-1] == str(switch == "enable")
    assert found.stderr == ""


def test_functions_that_numba_cannot_keep_are_compiled(run):
    """Without optimisation, numba keeps no machine code that refers to arrays of a module."""
    assert float(run(ROOT_OF_LINE, NUMBA_OPT="0").stdout.split()[0]) == 0.5
