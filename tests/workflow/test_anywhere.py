"""The workflow in another folder, and as a module of another workflow."""

import subprocess
import sys

import pytest
from project import ROOT

MODULE = """
module conveyor:
    snakefile: "{snakefile}"
    config: config["conveyor"]

use rule * from conveyor as conveyor_*

rule all:
    default_target: True
    input: "figures/mine/fig01.pdf", "results/mine/sweeps/few.parquet"
"""
CONFIG = """
conveyor:
  prefix: mine
  sweeps: {few: {axes: {z0: [0.0, 1.0e-4]}, duration: 0.02, needs: vertical}}
"""


def snakemake(folder, *arguments):
    command = [sys.executable, "-m", "snakemake", "--cores", "2", *arguments]
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr


def test_results_go_to_the_working_directory(tmp_path):
    folder = tmp_path / "elsewhere"
    snakemake(tmp_path, "--snakefile", str(ROOT / "Snakefile"), "--directory", str(folder), "figures/fig01.pdf")
    assert {path.name for path in folder.iterdir()} == {"figures", "results", ".snakemake"}
    assert (folder / "figures/fig01.pdf").stat().st_size > 10_000


def test_captions_and_pages_find_their_templates_from_elsewhere(tmp_path):
    arguments = ("--snakefile", str(ROOT / "Snakefile"), "--directory", str(tmp_path), "--dry-run")
    for target in ("results/captions/fig01.rst", "docs/companion.html", "article", "site", "all", "archive"):
        snakemake(ROOT.parent, target, *arguments)


@pytest.mark.parametrize("snakefile", ["Snakefile", "workflow/Snakefile"])
def test_the_workflow_is_a_module(tmp_path, snakefile):
    (tmp_path / "Snakefile").write_text(MODULE.format(snakefile=ROOT / snakefile))
    (tmp_path / "config.yaml").write_text(CONFIG)
    snakemake(tmp_path, "--configfile", "config.yaml")
    assert (tmp_path / "figures/mine/fig01.pdf").is_file()
    assert (tmp_path / "results/mine/sweeps/few.parquet").is_file()
