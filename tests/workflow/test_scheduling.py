"""When Snakemake looks for jobs: once for each that ends; and how many of them share a machine."""

import subprocess
import sys

import pytest
from project import ROOT

SHORT = 6
WORKFLOW = f"""
import sys
sys.path.insert(0, {str(ROOT)!r})
from workflow.scheduling import look_for_jobs_when_one_ends
look_for_jobs_when_one_ends()

rule all:
    input: "long", "wide"

rule short:
    output: touch("short_{{number}}")
    shell: "true"

rule long:
    priority: 1
    output: touch("long")
    shell: "sleep 4"

rule wide:
    input: expand("short_{{number}}", number=range({SHORT}))
    output: touch("wide")
    threads: 2
    shell: "true"
"""


def test_waiting_jobs_are_looked_at_when_one_ends_and_at_no_other_time(tmp_path):
    (tmp_path / "Snakefile").write_text(WORKFLOW)
    run = subprocess.run(
        [sys.executable, "-m", "snakemake", "--cores", "2", "--verbose"], cwd=tmp_path, capture_output=True, text=True
    )
    assert run.returncode == 0, run.stderr
    # At the beginning, and after each short job, the long one and the wide one.
    assert (run.stdout + run.stderr).count("Ready jobs:") <= 1 + SHORT + 2


@pytest.mark.parametrize(
    ("target", "cores", "kept", "used"),
    [
        ("results/estimates/phase.parquet", 2, 1, 2),
        ("results/estimates/phase.parquet", 1, 1, 1),
        ("results/benchmark.md", 4, 4, 4),
    ],
)
def test_a_job_keeps_one_core_and_computes_on_two(edited, target, cores, kept, used):
    """But it takes no more than there are; one that takes wall times keeps all."""
    told = "raise RuntimeError(f'keeps {job.threads}, computes on {offered}')"
    project = edited("scripts/make.py", "wanted = inspect", f"{told}\n    wanted = inspect")
    run = project.snakemake("--cores", str(cores), target)
    assert f"keeps {kept}, computes on {{'threads': {used}," in run.stdout
