"""The workflow in another folder, and as a module of another workflow."""

import re
import shutil
import subprocess

import pytest
from project import IN_PROCESS_OPTIONS, ROOT, call_snakemake, copy_project

MODULE = """
module conveyor:
    snakefile: "{snakefile}"
    config: config["conveyor"]

use rule * from conveyor as conveyor_*

rule all:
    default_target: True
    input: "figures/mine/fig01.pdf", "results/mine/sweeps/few.parquet"
"""
CONFIG = """
conveyor:
  prefix: mine
  sweeps: {few: {axes: {z0: [0.0, 1.0e-4]}, duration: 0.02, needs: vertical}}
"""


def snakemake(folder, *arguments):
    run = call_snakemake("--cores", "2", *arguments, folder=folder)
    assert run.returncode == 0, run.stdout
    return run.stdout


def test_results_go_to_the_working_directory(tmp_path):
    folder = tmp_path / "elsewhere"
    snakemake(tmp_path, "--snakefile", str(ROOT / "Snakefile"), "--directory", str(folder), "figures/fig01.pdf")
    assert {path.name for path in folder.iterdir()} == {"figures", "results", ".snakemake"}
    assert (folder / "figures/fig01.pdf").stat().st_size > 10_000


def test_a_file_of_the_repository_is_not_made_again_from_elsewhere(tmp_path):
    """It is made in the working directory, also if a rule reads the file of the repository."""
    arguments = ("--snakefile", str(ROOT / "Snakefile"), "--directory", str(tmp_path), "--dry-run")
    assert "output files have to be generated" in snakemake(ROOT.parent, "config/schema.json", *arguments)


MODULE_OF_THE_PAPER = f"""
module conveyor:
    snakefile: "{ROOT / "Snakefile"}"
    config: config
"""


def test_some_rules_of_the_module(tmp_path):
    (tmp_path / "Snakefile").write_text(MODULE_OF_THE_PAPER + "use rule motion, plot from conveyor")
    stdout = snakemake(tmp_path, "--dry-run", "figures/fig05.pdf")
    assert dict(re.findall(r"^(\w+) +(\d)$", stdout, re.MULTILINE)) == {"motion": "2", "plot": "1", "total": "3"}


@pytest.mark.parametrize("rule", ["caption", "all"])
def test_a_rule_of_the_module_works_alone(tmp_path, rule):
    """Also if it resembles another rule, or needs files of other rules."""
    (tmp_path / "Snakefile").write_text(MODULE_OF_THE_PAPER + f"use rule {rule} from conveyor")
    snakemake(tmp_path, "--list-rules")


def test_nested_values_of_the_command_line_reach_the_module(tmp_path):
    (tmp_path / "Snakefile").write_text(MODULE_OF_THE_PAPER + "use rule * from conveyor")
    run = call_snakemake("--dry-run", "figures/fig05.pdf", "--config", "model={damping: -0.2}", folder=tmp_path)
    assert "model.damping = '-0.2' should be at least 0" in run.stdout


@pytest.mark.long
def test_a_report_of_a_module_with_a_prefix(tmp_path):
    """It moves the caption, but not the template, which lies in the working directory here."""
    (tmp_path / "conveyor").mkdir()
    copy_project(tmp_path / "conveyor")
    (tmp_path / "Snakefile").write_text("""
module conveyor:
    snakefile: "conveyor/Snakefile"
    config: {"prefix": "mine", "figures": {"fig01": {"section": "Sketch", "needs": "nothing", "tables": {}}}}
    prefix: "moved"

use rule * from conveyor
""")
    target = "moved/results/mine/captions/fig01.rst"
    snakemake(tmp_path, *IN_PROCESS_OPTIONS, target)
    run = call_snakemake("--report", "report.html", target, folder=tmp_path)
    assert run.returncode == 0, run.stdout
    report = (tmp_path / "report.html").read_text(encoding="utf-8")
    words = (tmp_path / target).read_text(encoding="utf-8").split()[:4]
    assert f"<p>{' '.join(words)}" in report
    assert "Drawn by scripts/conveyor_pipeline/paper/figures/fig01.py" in report


def test_a_snakefile_in_a_folder_of_the_clone_gives_its_config(tmp_path):
    project = copy_project(tmp_path)
    (project / "study").mkdir()
    (project / "study/Snakefile").write_text(MODULE.format(snakefile="../Snakefile"))
    (project / "study/config.yaml").write_text(CONFIG)
    options = ("--snakefile", "study/Snakefile", "--configfile", "study/config.yaml")
    stdout = snakemake(project, "--dry-run", "results/mine/sweeps/few.parquet", *options)
    assert "output: results/mine/sweeps/few.parquet" in stdout


@pytest.mark.parametrize("options", [("--report", "r.html"), ("--summary",)])
def test_a_module_needs_no_number_of_cores(tmp_path, options):
    """For options that run no job."""
    (tmp_path / "Snakefile").write_text(MODULE_OF_THE_PAPER + "use rule * from conveyor")
    run = call_snakemake("config/schema.json", *options, folder=tmp_path)
    assert run.returncode == 0, run.stdout


OWN_PACKAGES = """
import sys

sys.path.insert(0, workflow.basedir)

import scripts.settings
import workflow.settings as settings

assert scripts.settings.NAME == settings.NAME == "own"
"""


def test_the_workflow_is_a_module_of_a_workflow_with_packages_of_its_own(tmp_path):
    """Named as the folders of this project, and imported before and after its module."""
    for name in ("workflow", "scripts", "docs", "figures", "pipeline"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "__init__.py").write_text("")
        (tmp_path / name / "settings.py").write_text('NAME = "own"')
    text = OWN_PACKAGES + MODULE.format(snakefile=ROOT / "Snakefile") + "\nimport figures.settings, docs.settings"
    (tmp_path / "Snakefile").write_text(text)
    (tmp_path / "config.yaml").write_text(CONFIG)
    snakemake(tmp_path, *IN_PROCESS_OPTIONS, "--configfile", "config.yaml")
    assert (tmp_path / "figures/mine/fig01.pdf").is_file()
    assert (tmp_path / "results/mine/sweeps/few.parquet").is_file()


TWO_MODULES = """
module first:
    snakefile: "{snakefile}"
    config: {{"prefix": "first"}}
    prefix: "one"

module second:
    snakefile: "{snakefile}"
    config: {{"prefix": "second", "model": {{"friction": 0.2}}}}
    prefix: "two"

use rule * from first as first_*
use rule * from second as second_*

rule all:
    default_target: True
    input: "one/figures/first/fig01.pdf", "two/figures/second/fig01.pdf"
"""


@pytest.mark.long  # two builds
def test_two_modules_with_prefixes(tmp_path):
    (tmp_path / "Snakefile").write_text(TWO_MODULES.format(snakefile=ROOT / "Snakefile"))
    snakemake(tmp_path, *IN_PROCESS_OPTIONS)
    assert (tmp_path / "one/figures/first/fig01.pdf").is_file()
    assert (tmp_path / "two/figures/second/fig01.pdf").is_file()
    tables = ["one/results/first/estimates/phase.parquet", "two/results/second/estimates/phase.parquet"]
    stdout = snakemake(tmp_path, "--dry-run", *tables)
    jobs = dict(re.findall(r"^((?:first|second)_\w+) +(\d+)$", stdout, re.MULTILINE))
    assert jobs == {"first_estimates": "1", "second_estimates": "1"}


FROM_GIT = """
module conveyor:
    snakefile: gitfile("{repository}", path="{path}", tag="v1")
    config: {{"prefix": "mine", "figures": {{"fig01": {{"section": "Sketch", "needs": "nothing", "tables": {{}}}}}}}}

use rule * from conveyor
"""


@pytest.fixture(scope="module")
def repository(tmp_path_factory):
    """A Git repository of the project with the tag v1."""
    folder = copy_project(tmp_path_factory.mktemp("repository"))
    for arguments in (["init"], ["add", "."], ["commit", "--message", "All"], ["tag", "v1"]):
        command = ["git", "-c", "user.name=A", "-c", "user.email=a@example.org", *arguments]
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
    return folder


@pytest.mark.long
def test_a_module_from_a_git_repository(tmp_path, repository):
    """Also by its other entry, workflow/Snakefile."""
    (tmp_path / "Snakefile").write_text(FROM_GIT.format(repository=repository, path="workflow/Snakefile"))
    snakemake(tmp_path, "figures/mine/fig01.pdf")
    assert (tmp_path / "figures/mine/fig01.pdf").is_file()
    assert "Nothing to be done" in snakemake(tmp_path, "figures/mine/fig01.pdf")
    # A checkout without its files, as a clean-up of old files leaves it, is made again.
    (checkout,) = (tmp_path / ".snakemake/conveyor").iterdir()
    shutil.rmtree(checkout)
    checkout.mkdir()
    snakemake(tmp_path, "--dry-run", "figures/mine/fig01.pdf")
    assert (checkout / "Snakefile").is_file()


def test_the_snakefile_alone_names_the_entry_for_git(tmp_path, repository):
    (tmp_path / "Snakefile").write_text(FROM_GIT.format(repository=repository, path="Snakefile"))
    run = call_snakemake("--dry-run", "figures/mine/fig03.pdf", folder=tmp_path)
    assert run.returncode != 0
    assert 'name path="workflow/Snakefile"' in run.stdout
    assert "Traceback" not in run.stdout
