"""Foreign files in place of tables: an error names the file and the remedy; no wrong number results."""

import re
import shutil

import pytest
from project import IN_PROCESS_OPTIONS

SWEEP = "results/sweeps/amplitudes.parquet"
OTHER = r"was made from settings other than those requested \(model.damping = 0.2, not 0.3\)"


@pytest.fixture(scope="module")
def damped(built):
    """The folder of results for another damping."""
    project = built.under({"prefix": "damped", "model": {"damping": 0.2}})
    project.make_in_process("results/damped/sweeps/amplitudes.parquet")
    return built.folder / "results/damped"


def test_a_wrong_table_is_named_and_made_again_once_it_is_deleted(copied, damped):
    path = copied.folder / SWEEP
    sound = path.read_bytes()
    shutil.copyfile(damped / path.relative_to(copied.folder / "results"), path)
    run = copied.snakemake(*IN_PROCESS_OPTIONS, "figures/fig03.pdf")
    assert run.returncode != 0, run.stdout
    assert re.search(f"{SWEEP} {OTHER}.*; delete it, and the next run makes it again", run.stdout), run.stdout
    path.unlink()
    copied.make_in_process(SWEEP)
    assert path.read_bytes() == sound
