"""The README's command for a cluster, on a Slurm of one node that is started for these tests."""

import math
import re
import shlex

import pytest
import yaml
from project import ROOT, Project, copy_project

import local_slurm
from conveyor_pipeline.common.axes import count_points

GUIDE = ROOT / "docs/guides/own_sweep.md"
OBSTACLE = local_slurm.obstacle()
pytestmark = pytest.mark.skipif(OBSTACLE is not None, reason=f"no Slurm can be started: {OBSTACLE}")

# The sweep of the guide, in three shards.
MINE = yaml.safe_load(re.search(r"```yaml\n(.*?)```", GUIDE.read_text(), re.DOTALL)[1])
OVERLAY = {**MINE, "sharing": {"rows": math.ceil(count_points(MINE["sweeps"]["mine"]["axes"]) / 3)}}
TABLE, FIGURE = "results/sweeps/mine.parquet", "figures/fig22.pdf"
SHARD = "rule_shards_wildcards_mine_1"  # as Snakemake names its job to Slurm
COMPUTING = 120.0  # s


@pytest.fixture(scope="module")
def slurm(tmp_path_factory):
    with local_slurm.slurm(tmp_path_factory.mktemp("slurm")):
        yield


@pytest.fixture(scope="module")
def local(tmp_path_factory) -> Project:
    """The table and the figure, made without a cluster."""
    project = Project(copy_project(tmp_path_factory.mktemp("local")), OVERLAY)
    project.make("--cores", "2", TABLE, FIGURE)
    return project


def command() -> list[str]:
    """The options of the README's command for a cluster."""
    (line,) = re.findall(r"`snakemake (--workflow-profile [^`]*slurm)`", (ROOT / "README.md").read_text())
    return shlex.split(line)


def test_a_cluster_makes_what_one_machine_makes(slurm, local, tmp_path):
    """One of its running shards is cancelled on the way."""
    project = Project(copy_project(tmp_path), OVERLAY)
    run = project.started(*command(), *project.configfile(), "--", TABLE, FIGURE)
    try:
        local_slurm.until(lambda: SHARD in local_slurm.jobs("RUNNING").values(), f"{SHARD} runs", COMPUTING)
        (cancelled,) = (number for number, name in local_slurm.jobs("RUNNING").items() if name == SHARD)
        local_slurm.cancel(cancelled)
        said, _ = run.communicate(timeout=COMPUTING)
    finally:
        run.kill()
    assert run.returncode == 0, said
    assert f"SLURM-job '{cancelled}' failed, SLURM status is: 'CANCELLED'" in said
    for file in (TABLE, FIGURE):
        assert (project.folder / file).read_bytes() == (local.folder / file).read_bytes(), file
