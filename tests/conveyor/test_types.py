"""Type checkers accept a program that uses the front door."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import conveyor

PROGRAM = """
import numpy as np

from conveyor import *

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
# Lists stand for arrays, and a Conveyor and rows for each other.
wavy = Conveyor(harmonics=[{"order": 2, "normal": 0.1}, Harmonic(3)])
xs: np.ndarray = simulate(table[0], duration=1.0).sample([0.0, 0.1])["x"]
plate_motion(*conveyor_and_start(replace_parameters(wavy, tension="clip"))[:1], [0.0, 0.1])
diagram: Columns = bifurcation_diagram(table, strobes=2, threads=2)
sweep(wavy, duration=[1.0, 2.0]).to_frame()
sample_runs(table, [[0.0, 0.1], [0.0, 0.1]], columns=["x"])
transits(table, [0.1], [1.0], begin=0.0)
block_transits(table, Block(5e-3, 1e-3), [0.0, 0.1], length=0.1, longest=1.0, begin=[0.0, 0.0])
start_at(table, restart(table, runs.z_end, runs.vz_end, 0.5)["z0"])
windowed_spectrum([1.0, 2.0], 0.02).amplitude.max()
ratios: np.ndarray = doubling_ratios([one.orbit.acceleration for one in branch.bifurcations])
continue_orbit(orbit, "damping", [0.2, 0.4])
periodic_orbit(wavy, [-5e-4, 0.02])
lyapunov_spectrum(wavy, strobes(wavy, 1))
dimension: Dimension = box_dimension([[0.0, 1.0]])
"""


@pytest.mark.long
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
