"""The code that runs is the code that the rules hash, whatever else is installed or set in the environment."""

import os

import pytest
from project import Project

TABLE = "results/sweeps/on_plate.parquet"


def test_jobs_import_the_library_of_the_project(copied, tmp_path):
    """Not an installed one, as after `pip install .`; a change of the project's would then be hashed but not run."""
    other = tmp_path / "conveyor/__init__.py"
    other.parent.mkdir()
    other.write_text("raise ImportError('this is the installed copy')")
    project = Project(copied.folder, environment={"PYTHONPATH": str(tmp_path)})
    run = project.snakemake("--cores", "1", "--force", TABLE)
    assert run.returncode == 0, run.stdout


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


def test_figures_are_drawn_under_a_backend_that_is_not_installed(copied):
    """A terminal of Jupyter sets this variable; Matplotlib refuses this name, not any, if the package is missing."""
    backend = "module://matplotlib_inline.backend_inline"
    project = Project(copied.folder, environment=dict(os.environ) | {"MPLBACKEND": backend})
    run = project.snakemake("--cores", "1", "--force", "figures/fig22.pdf")
    assert run.returncode == 0, run.stdout
