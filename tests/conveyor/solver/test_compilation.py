"""What numba compiles in a session: said once, and timed."""

import os
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest
from filelock import FileLock
from project import ROOT

from conveyor.solver.compilation import LONGEST_WAIT, NOTICE

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
# The functions that numba compiles for a contact step and Euler steps on a pure plate, then for one with a harmonic.
FUNCTIONS_BY_PLATE = """
from numba.core.event import install_recorder
from conveyor import Conveyor, Start, simulate
from conveyor.solver import contact, plate
from conveyor.solver.model import pack
from conveyor.solver.workspace import FIRST

with install_recorder("numba:compile") as recorder:
    c = contact.constants(pack(Conveyor(), Start()), 1e-10)
    contact.begin_step(c, contact.workspace(), FIRST, 0.0, 0.3, 0.0, 1.0, False)
    plate.height_and_rise(c, 0.0, 1.0)
    simulate(Conveyor(), duration=1e-3, method="euler", step=1e-5)
    pure = len(recorder.buffer)
    c = contact.constants(pack(Conveyor(harmonics=[{"order": 2, "normal": 0.1}]), Start()), 1e-10)
    plate.height_and_rise(c, 0.0, 1.0)
names = [event.data["dispatcher"].py_func.__name__ for _, event in recorder.buffer if event.is_start]
print(*names[: pure // 2])
print(*names[pure // 2 :])
"""
# All that follow runs, from tables and times of any layout.
SIGNATURES = """
import numpy as np
from conveyor import Conveyor, Start, parameter_table, sample_runs, simulate, sweep, transits
from conveyor.solver import trajectory

run = simulate(Conveyor(), Start(z=3e-4), duration=1)
run.sample(np.array([0.5], dtype=np.float32))
run.events
table = parameter_table(Conveyor(), acceleration=[[30.0], [40.0]], z0=[0.0, 3e-4])
table.flags.writeable = False
sweep(table, duration=0.1, needs="vertical")
sweep(table.T, duration=np.full((2, 2), 0.1).T)
sample_runs(table[0], np.array([[0.0, 0.1], [0.1, 0.1]], order="F"), columns=["z"], skip=True)
transits(table[1], np.array([0.01]), np.array([1]), begin=0)
print(len(trajectory.follow.__wrapped__.signatures))
"""
LOCK = "conveyor/compiling-others.lock"
LOCK_OF_EVENTS = "conveyor/compiling-conveyor.solver.trajectory.follow.lock"
FIXED_STEPS = """
from conveyor import Conveyor, simulate
from conveyor.solver import compilation

simulate(Conveyor(acceleration=30.0), duration=0.01, method="euler", step=1e-6)
print(compilation.compile_seconds())
"""
IMPATIENT = """
from conveyor.solver import compilation
compilation.LONGEST_WAIT = 0.1
"""
HOLD_LOCK = """
import sys, time
from filelock import FileLock
FileLock(sys.argv[1]).acquire()
print(flush=True)
time.sleep(60.0)
"""
OTHER = """
import numba
from conveyor.solver import jit

print(numba.njit(lambda number: number + 1)(1))
"""


@pytest.fixture
def run(tmp_path):
    """A function that runs code in a new session, with a cache that is empty at first; an error if it waits long."""

    def in_session(code, **variables):
        environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path), "PYTHONPATH": str(ROOT / "scripts")} | variables
        environment.pop("NUMBA_CACHE_DIR", None)
        command = [sys.executable, "-W", "ignore", "-c", code]
        options = {"capture_output": True, "text": True, "check": True, "timeout": 0.9 * LONGEST_WAIT}
        return subprocess.run(command, env=environment, **options)

    return in_session


def test_the_notice_comes_once_and_not_from_the_cache(run, tmp_path):
    """Also in the log of a rule."""
    code = f"from conveyor_pipeline.common.rule_log import logged\nwith logged('{tmp_path}/rule.log'):\n"
    first, later = run(code + ROOT_OF_LINE.replace("\n", "\n    ")), run(ROOT_OF_LINE)
    assert first.stderr == (tmp_path / "rule.log").read_text() == f"{NOTICE}\n"
    assert float(first.stdout.split()[-1]) > 0.0
    assert later.stderr == ""
    assert float(later.stdout.split()[-1]) == 0.0


@pytest.mark.long
@pytest.mark.parametrize("code", [ROOT_OF_LINE, FIXED_STEPS], ids=["others", "entry"])
def test_of_processes_that_start_together_one_compiles(run, code):
    with ThreadPoolExecutor() as threads:
        found = list(threads.map(run, [code] * 3))
    assert sorted(each.stderr for each in found) == ["", "", f"{NOTICE}\n"]
    seconds = sorted(float(each.stdout.split()[-1]) for each in found)
    assert seconds[:2] == [0.0, 0.0] < seconds[2:]


@pytest.mark.long
def test_a_process_does_not_wait_for_ever(run, tmp_path):
    """The process that compiles may have been suspended."""
    (tmp_path / "conveyor").mkdir()
    with FileLock(tmp_path / LOCK):
        found = run(IMPATIENT + ROOT_OF_LINE)
    assert [float(number) > 0.0 for number in found.stdout.split()] == [True, True]


@pytest.mark.long
def test_an_entry_does_not_wait_for_another(run, tmp_path):
    (tmp_path / "conveyor").mkdir()
    with FileLock(tmp_path / LOCK_OF_EVENTS):
        found = run(FIXED_STEPS)
    assert float(found.stdout) > 0.0


@pytest.mark.long
def test_a_killed_process_leaves_no_lock(run, tmp_path):
    (tmp_path / "conveyor").mkdir()
    command = [sys.executable, "-c", HOLD_LOCK, str(tmp_path / LOCK)]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as holder:
        holder.stdout.readline()
        holder.send_signal(signal.SIGKILL)
    assert float(run(ROOT_OF_LINE).stdout.split()[0]) == 0.5


@pytest.mark.long
def test_a_plate_without_harmonics_compiles_no_code_of_harmonics(run):
    of_harmonics = {"add_harmonic", "multiple", "numbers_of"}
    pure, harmonic = (set(line.split()) for line in run(FUNCTIONS_BY_PLATE).stdout.splitlines())
    assert {"expand_hertz", "expand_other", "height_and_rise"} <= pure
    # These functions serve plates with harmonics only.
    assert not pure & (
        of_harmonics | {"add_sums", "begin_waves", "expand_harmonic_hertz", "numbers_at", "rows_of_wave"}
    )
    assert of_harmonics <= harmonic


def test_one_solver_follows_all_runs(run):
    """Another type of an argument would compile the solver once more, for seconds."""
    found = run(SIGNATURES, XDG_CACHE_HOME=os.environ.get("XDG_CACHE_HOME", ""))  # not an empty cache
    assert found.stdout == "1\n"


def test_functions_of_others_give_no_notice_and_the_garbage_collector_is_left_as_it_was(run):
    code = f"import gc{OTHER}print(gc.isenabled())\ngc.disable(){OTHER}print(gc.isenabled())"
    found = run(code)
    assert found.stdout.split() == ["2", "True", "2", "False"]
    assert found.stderr == ""


@pytest.mark.long
def test_functions_that_numba_cannot_keep_are_compiled(run):
    """Without optimisation, numba keeps no machine code that refers to arrays of a module."""
    assert float(run(ROOT_OF_LINE, NUMBA_OPT="0").stdout.split()[0]) == 0.5
