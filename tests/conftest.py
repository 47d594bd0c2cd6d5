"""A project that is built once from a small config, and copies of it for tests that change something."""

import fcntl
import os
import shutil

import pytest
from project import Project, copy_project


def pytest_configure() -> None:
    """One thread of BLAS, before NumPy is imported: with two in each worker, they wait for each other's cores."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


@pytest.fixture(scope="session")
def built(tmp_path_factory, worker_id) -> Project:
    """A built project; tests must not change its sources or results. One worker builds it, and each has a copy."""
    own = tmp_path_factory.getbasetemp()
    first = (own if worker_id == "master" else own.parent) / "first_build"
    with open(f"{first}.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not first.exists():
            first.mkdir()
            Project(copy_project(first)).make_in_process("all", "docs/companion.html")
    return Project(shutil.copytree(first, own / "built", symlinks=True))


@pytest.fixture(scope="module")
def project(tmp_path_factory) -> Project:
    """A copy of the project without results."""
    return Project(copy_project(tmp_path_factory.mktemp("project")))


@pytest.fixture
def copied(built, tmp_path) -> Project:
    """A copy of the built project, which a test may change."""
    return Project(shutil.copytree(built.folder, tmp_path / "copy", symlinks=True))


@pytest.fixture
def edited(copied):
    """A function that edits one file of a copy of the built project and returns the copy."""

    def edit(file: str, old: str, new: str) -> Project:
        path = copied.folder / file
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new))
        return copied

    return edit
