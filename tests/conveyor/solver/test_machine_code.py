"""The cache of compiled code: its folder depends on the content of imported modules, and only the user can write it."""

import os
import stat
import tempfile

import pytest

from conveyor.solver import imports, machine_code

CACHED = (imports.direct_imports, machine_code.syntax, machine_code.content)


@pytest.fixture
def library(tmp_path, monkeypatch):
    """A small library; a function writes one of its files and returns the content of a module."""
    files = {
        "solver/model.py": "G = 9.81\n",
        "solver/contact.py": "from .model import G\n",
        "analysis/orbits.py": "from ..solver import contact\n",
        "analysis/states.py": "from ..solver.model import G\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(machine_code, "LIBRARY", tmp_path)

    def content(module, **texts):
        for name, text in texts.items():
            (tmp_path / f"{name.replace('__', '/')}.py").write_text(text)
        for cached in CACHED:
            cached.cache_clear()
        return machine_code.content(tmp_path / f"{module}.py")

    yield content
    for cached in CACHED:
        cached.cache_clear()


def test_only_imported_modules_count(library):
    before = {name: library(name) for name in ("analysis/orbits", "analysis/states", "solver/contact")}
    assert len(set(before.values())) == 3
    changed = "from .model import G\nW = 0\n"
    assert library("analysis/orbits", solver__contact=changed) != before["analysis/orbits"]
    assert library("solver/contact") != before["solver/contact"]
    assert library("analysis/states") == before["analysis/states"]
    assert library("analysis/states", solver__model="G = 9.8\n") != before["analysis/states"]


def test_comments_do_not_count(library):
    before = library("analysis/orbits")
    assert library("analysis/orbits", solver__contact="# as it was\n\nfrom .model import G  # m/s²\n") == before


def test_the_folder_belongs_to_one_user(tmp_path, monkeypatch):
    """Otherwise code from other users could run."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    own = tmp_path / f"conveyor-{os.getuid()}"
    assert own in list(machine_code.roots())
    assert stat.S_IMODE(own.stat().st_mode) == 0o700
    own.chmod(0o777)
    *_, fresh = machine_code.roots()
    assert own not in list(machine_code.roots())
    assert stat.S_IMODE(fresh.stat().st_mode) == 0o700
    own.rmdir()
    own.symlink_to(tmp_path)
    assert own not in list(machine_code.roots())


def test_a_folder_that_cannot_be_written_is_skipped(tmp_path, monkeypatch):
    blocked = tmp_path / "file"
    blocked.write_text("no folder")
    monkeypatch.setattr(machine_code, "roots", lambda: iter([blocked / "below", tmp_path / "good"]))
    assert machine_code.root.__wrapped__() == tmp_path / "good"
