"""Where compiled code is kept: by the content of the library, and nowhere that others can write."""

import os
import stat
import tempfile

import pytest

from conveyor.solver import machine_code
from conveyor_pipeline.common.imports import direct_imports


def a_function():
    pass


@pytest.fixture
def library(tmp_path, monkeypatch):
    """A small library in place of this one; a function writes a file of it and gives the folders' contents."""
    files = {
        "parameters": "G = 9.81\n",
        "arguments": "G = 9.81\n",
        "parallel": "G = 9.81\n",
        "progress": "G = 9.81\n",
        "solver/contact": "W = 0\n",
        "analysis/orbits": "W = 1\n",
    }
    monkeypatch.setattr(machine_code, "LIBRARY", tmp_path)
    monkeypatch.setattr(machine_code, "SOLVER", tmp_path / "solver")

    def contents(**changed):
        for name, text in (files | {name.replace("__", "/"): text for name, text in changed.items()}).items():
            (tmp_path / f"{name}.py").parent.mkdir(exist_ok=True)
            (tmp_path / f"{name}.py").write_text(text)
        machine_code.content.cache_clear()
        places = tmp_path / "solver/contact.py", tmp_path / "analysis/orbits.py"
        return tuple(machine_code.ByContent(a_function, str(file)).content for file in places)

    yield contents
    machine_code.content.cache_clear()


@pytest.mark.parametrize(
    ("changed", "same"),
    [
        ("parameters", (False, False)),
        ("arguments", (False, False)),
        ("solver__contact", (False, False)),
        ("analysis__orbits", (True, False)),
    ],
)
def test_a_change_gives_a_new_folder_to_all_code_that_may_hold_it(library, changed, same):
    before, after = library(), library(**{changed: "G = 9.8\n"})
    assert tuple(one == other for one, other in zip(before, after, strict=True)) == same
    assert library() == before


def test_modules_with_one_name_have_folders_of_their_own(library):
    library()
    files = [machine_code.LIBRARY / "analysis/newton.py", machine_code.LIBRARY / "certificates/newton.py"]
    one, other = (machine_code.ByContent(a_function, str(file)) for file in files)
    assert one.content == other.content
    assert one.get_cache_path() != other.get_cache_path()


def test_a_new_module_gives_a_new_folder(library):
    before = library()
    assert all(one != other for one, other in zip(before, library(solver__flight="W = 2\n"), strict=True))


def test_modules_of_the_solver_import_only_what_their_folder_is_named_by():
    for file in machine_code.SOLVER.rglob("*.py"):
        used, _ = direct_imports(file, machine_code.LIBRARY.parent)
        named_by = {*(machine_code.LIBRARY / name for name in machine_code.SHARED), *machine_code.SOLVER.rglob("*.py")}
        assert used <= named_by | {machine_code.LIBRARY / "__init__.py"}, file


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
