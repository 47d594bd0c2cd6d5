"""The code that runs is the code that the rules hash, whatever else is installed or set in the environment."""

import os
import shutil

import pytest
from project import Project

TABLE = "results/sweeps/on_plate.parquet"


@pytest.fixture
def shadowed(copied, tmp_path):
    """A copy of the built project, and another package `conveyor`, which comes before installed packages."""
    other = tmp_path / "site/conveyor/__init__.py"
    other.parent.mkdir(parents=True)
    other.write_text("raise ImportError('this is the installed copy')")
    return Project(copied.folder, environment={"PYTHONPATH": str(other.parents[1])}), other


@pytest.mark.long
def test_jobs_import_the_library_of_the_project(shadowed):
    """Not an installed one, as after `pip install .`; a change of the project's would then be hashed but not run."""
    project, _ = shadowed
    run = project.snakemake("--cores", "1", "--force", TABLE)
    assert run.returncode == 0, run.stdout


def test_a_job_that_would_run_other_code_names_both(shadowed):
    """Here Python imports the other package at its start, before the script can put the project first."""
    project, other = shadowed
    shutil.copytree(project.folder / "scripts/conveyor", other.parent, dirs_exist_ok=True)
    (other.parents[1] / "sitecustomize.py").write_text("import conveyor")
    run = project.snakemake("--cores", "1", "--force", TABLE)
    assert run.returncode != 0
    assert f"would run {other}, but the rules hash {project.folder}/scripts/conveyor" in run.stdout.replace("\n", " ")
    assert not (project.folder / TABLE).exists()


@pytest.fixture
def late(copied):
    """A function that runs the table's job with a Snakefile that writes a file after it has hashed the code."""

    def run(file: str, text: str):
        path = copied.folder / file
        lines = ['include: "Snakefile"', "", "onstart:", f"    open({str(path)!r}, 'w').write({text!r})", ""]
        (copied.folder / "late.smk").write_text("\n".join(lines))
        return copied.snakemake("--snakefile", "late.smk", "--cores", "1", "--force", TABLE)

    return run


def test_a_job_whose_code_was_changed_after_it_was_hashed_ends_with_the_remedy(copied, late):
    """Else the table counts as one of the hashed code, also when the change is undone, as by two `git switch`."""
    file = "scripts/conveyor_pipeline/common/tables.py"
    run = late(file, (copied.folder / file).read_text() + "# other\n")
    assert run.returncode != 0
    assert "was changed after Snakemake had read it; run Snakemake again" in run.stdout
    assert not (copied.folder / TABLE).exists()


def test_a_change_of_other_code_stops_no_job(late):
    run = late("scripts/conveyor_pipeline/later.py", "")
    assert run.returncode == 0, run.stdout


@pytest.mark.long
def test_figures_are_drawn_under_a_backend_that_is_not_installed(copied):
    """A terminal of Jupyter sets this variable; Matplotlib refuses this name, not any, if the package is missing."""
    backend = "module://matplotlib_inline.backend_inline"
    project = Project(copied.folder, environment=dict(os.environ) | {"MPLBACKEND": backend})
    run = project.snakemake("--cores", "1", "--force", "figures/fig22.pdf")
    assert run.returncode == 0, run.stdout
