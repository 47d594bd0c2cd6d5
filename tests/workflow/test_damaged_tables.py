"""Foreign files in place of tables: an error names the file and the remedy; no wrong number results."""

import re
import shutil

import pytest
from project import IN_PROCESS_OPTIONS

RUNS, SWEEP = "results/shards/amplitudes/0.parquet", "results/sweeps/amplitudes.parquet"
OTHER = r"was made from settings other than those requested \(model.damping = 0.2, not 0.3\)"


@pytest.fixture(scope="module")
def damped(built):
    """The folder of results for another damping."""
    project = built.under({"prefix": "damped", "model": {"damping": 0.2}})
    project.make_in_process("results/damped/sweeps/amplitudes.parquet")
    return built.folder / "results/damped"


@pytest.mark.parametrize("file", [RUNS, SWEEP], ids=["a shard of another physics", "a sweep of another physics"])
def test_a_wrong_table_is_named_and_made_again_once_it_is_deleted(copied, damped, file):
    path = copied.folder / file
    sound = path.read_bytes()
    shutil.copyfile(damped / path.relative_to(copied.folder / "results"), path)
    run = copied.snakemake(*IN_PROCESS_OPTIONS, "figures/fig03.pdf")
    assert run.returncode != 0, run.stdout
    assert re.search(f"{file} {OTHER}.*; delete it, and the next run makes it again", run.stdout), run.stdout
    path.unlink()
    copied.make_in_process(file)
    assert path.read_bytes() == sound
