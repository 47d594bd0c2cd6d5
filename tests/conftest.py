"""A project that was made once on a small config, and copies of it to edit."""

import shutil

import pytest
from project import CAPTIONS, TARGETS, Project, copy_project


@pytest.fixture(scope="session")
def built(tmp_path_factory) -> Project:
    """A project whose figures have been made; tests leave its sources and results as they are."""
    project = Project(copy_project(tmp_path_factory.mktemp("built")))
    project.make(*TARGETS, *CAPTIONS, "results/claims.md", "docs/companion.html")
    return project


@pytest.fixture
def edited(built, tmp_path):
    """A function that edits one file of a copy of the built project and gives the copy."""

    def edit(file: str, old: str, new: str) -> Project:
        folder = tmp_path / "copy"
        shutil.copytree(built.folder, folder, symlinks=True)
        path = folder / file
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new))
        return Project(folder)

    return edit
