"""A project that was made once on a small config, and copies of it to edit."""

import shutil

import pytest
from project import Project, copy_project


@pytest.fixture(scope="session")
def built(tmp_path_factory) -> Project:
    """A project whose figures have been made; tests leave its sources and results as they are."""
    project = Project(copy_project(tmp_path_factory.mktemp("built")))
    project.make("all", "docs/companion.html")
    return project


@pytest.fixture
def copied(built, tmp_path) -> Project:
    """A copy of the built project, to do anything to."""
    return Project(shutil.copytree(built.folder, tmp_path / "copy", symlinks=True))


@pytest.fixture
def edited(copied):
    """A function that edits one file of a copy of the built project and gives the copy."""

    def edit(file: str, old: str, new: str) -> Project:
        path = copied.folder / file
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new))
        return copied

    return edit
