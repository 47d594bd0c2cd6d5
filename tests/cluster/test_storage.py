"""Results in a storage that jobs do not share as a file system, as on a cluster with object storage."""

import shutil

import pytest
from project import TARGETS

pytest.importorskip("snakemake_storage_plugin_fs")


@pytest.mark.skipif(not shutil.which("rsync"), reason="the storage plugin copies files with rsync")
def test_results_in_a_storage_equal_results_in_the_folder(built, copied, tmp_path):
    (target, *_) = TARGETS
    for folder in ("results", "figures"):
        shutil.rmtree(copied.folder / folder)
    storage = ("--default-storage-provider", "fs", "--default-storage-prefix", str(tmp_path / "storage"))
    run = copied.called(target, *storage, "--shared-fs-usage", "none")
    assert run.returncode == 0, run.stdout
    assert (tmp_path / "storage" / target).read_bytes() == (built.folder / target).read_bytes()
    assert not (copied.folder / "results").exists()
