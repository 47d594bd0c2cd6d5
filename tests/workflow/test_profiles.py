"""Profiles and interpreters: independence of where and how Snakemake is called."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from project import ROOT

from conveyor_pipeline.common import check_results

SBATCH = """#!/bin/sh
echo "$@" >> "{calls}"
exit 1
"""


def run(project, *arguments, path):
    """Run Snakemake by its full path, as in a new shell, with a given PATH."""
    return subprocess.run(
        [Path(sys.executable).with_name("snakemake"), *arguments],
        cwd=project.folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
        env={"PATH": path, "HOME": os.environ["HOME"]},
    )


def test_slurm_gets_the_jobs(edited, tmp_path):
    """A dry run would hide an invalid profile, so a scheduler that refuses every job gets the first ones."""
    pytest.importorskip("snakemake_executor_plugin_slurm")
    project = edited(
        "scripts/conveyor_pipeline/paper/orbits/estimates.py", "import numpy as np\n", "import numpy as np  # changed\n"
    )
    calls, commands = tmp_path / "calls", tmp_path / "commands"
    commands.mkdir()
    for command in ("sbatch", "squeue", "sinfo", "sacct"):
        (commands / command).write_text(SBATCH.format(calls=calls) if command == "sbatch" else "#!/bin/sh\n")
        (commands / command).chmod(0o755)
    profile = ("--workflow-profile", "workflow/profiles/slurm", "--retries", "0", "--latency-wait", "0")
    profile += ("--slurm-init-seconds-before-status-checks", "1")
    found = run(project, "figures/fig22.pdf", *profile, "--keep-going", path=f"{commands}:/usr/bin:/bin")
    assert found.returncode != 0
    assert calls.is_file(), found.stdout
    submitted = calls.read_text().splitlines()
    assert all("--cpus-per-task=1" in call for call in submitted)


@pytest.mark.long
def test_results_are_checked_by_the_interpreter_that_runs_snakemake(tmp_path, monkeypatch):
    """PATH has no Python."""
    (tmp_path / "tests/results").mkdir(parents=True)
    test = tmp_path / "tests/results/test_one.py"
    test.write_text("def test_one():\n    pass\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", "/nowhere")
    assert check_results.make("results", {}, "tests/results") == "1 passed\n"
    test.write_text("def test_one():\n    assert 1 == 2\n")
    with pytest.raises(RuntimeError, match="assert 1 == 2"):
        check_results.make("results", {}, "tests/results")


def test_no_rule_finds_its_command_on_the_path():
    """Commands of `shell:` would be looked up there; scripts run with Snakemake's own interpreter."""
    rules = list((ROOT / "workflow/rules").rglob("*.smk"))
    assert len(rules) > 10
    for file in rules:
        assert "shell:" not in file.read_text(), file
