"""Targets of the rule `motion`, which serves several sections of the config."""

import subprocess
import sys

from project import ROOT


def test_an_entry_of_another_section_is_refused_with_the_key():
    command = [sys.executable, "-m", "snakemake", "--dry-run", "results/signals/heights.parquet"]
    run = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    assert run.returncode == 1
    assert "the config has no entry signals.heights; add it, or name another entry" in run.stdout
