"""Type checkers accept a program that uses the front door."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import conveyor

PROGRAM = """
import numpy as np

from conveyor import Branch, Columns, Conveyor, Orbit, Run, Start, attractors, basin, classify, continue_bifurcation
from conveyor import continue_orbit, parameter_table, periodic_orbit, simulate, sweep

run: Run = simulate(Conveyor(acceleration=40.0), Start(z=3e-4), duration=1.0)
velocity: float = run.mean_velocity()
table: np.ndarray = parameter_table(Conveyor(), z0=[0.0, 1e-4])
runs: Columns = sweep(table, threads=2, progress="runs")
speeds: np.ndarray = runs.mean_velocity
labels = classify(table, attractors=attractors(Conveyor()), other_tolerance=1e-11).to_frame(table)
orbit: Orbit | None = periodic_orbit(Conveyor(), np.array([-5e-4, 0.02]), period=range(1, 9))
assert orbit is not None
branch: Branch = continue_orbit(orbit, "damping", (0.2, 0.4))
curve = continue_bifurcation(branch.bifurcations[0], "mass", (6e-4, 8e-4))
found = basin(Conveyor(), [0.0, 1e-4], 0.0).attractors.found[0].share
"""


def test_mypy_accepts_a_program(tmp_path):
    pytest.importorskip("mypy", reason="a type checker, which the pipeline does not need")
    (tmp_path / "program.py").write_text(PROGRAM)
    command = [sys.executable, "-m", "mypy", "--follow-imports=silent", "--cache-dir", str(tmp_path), "program.py"]
    library = str(Path(conveyor.__file__).parents[1])
    run = subprocess.run(command, cwd=tmp_path, env=os.environ | {"MYPYPATH": library}, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout


def test_every_public_name_is_exported_explicitly():
    stub = Path(conveyor.__file__).with_suffix(".pyi").read_text()
    assert [name for name in conveyor.__all__ if f"{name} as {name}" not in stub] == []
