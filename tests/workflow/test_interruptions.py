"""Interrupted runs: a closed terminal leaves nothing behind."""

import os
import signal
import time

import pytest

pytestmark = pytest.mark.long

TARGET, LOG = "results/{prefix}/estimates/phase.parquet", "results/{prefix}/logs/estimates/phase.log"


def ended(built, prefix, end):
    """A project whose job was interrupted, its target, and the process of Snakemake."""
    # So long that the job still runs when it is interrupted; the project that is returned has a short one.
    project = built.under({"prefix": prefix, "estimates": {"phase": {"duration": 20.0}}})
    target = TARGET.format(prefix=prefix)
    process = project.started(target, *project.configfile())
    log = project.folder / LOG.format(prefix=prefix)
    while not log.exists():
        assert process.poll() is None, process.stdout.read()
        time.sleep(0.05)
    end(process.pid)
    # Wait until neither Snakemake nor its jobs can write any more.
    process.communicate(timeout=60)
    return built.under({"prefix": prefix}), target, process


@pytest.mark.parametrize("end", [os.kill, os.killpg], ids=["Snakemake", "all of the terminal"])
def test_a_closed_terminal_leaves_no_lock_and_no_process(built, end):
    project, target, process = ended(built, f"closed_{end.__name__}", lambda pid: end(pid, signal.SIGHUP))
    assert process.returncode == 1
    with pytest.raises(ProcessLookupError):
        os.killpg(process.pid, 0)
    project.make_in_process(target)
