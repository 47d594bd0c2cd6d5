"""When Snakemake looks for jobs: once for each that ends."""

import subprocess
import sys

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
