"""Files, names and commands in guides, pre-commit, GitHub Actions and the workflow catalogue exist."""

import re
import shlex
import subprocess
import tomllib

import numpy as np
import pandas as pd
import pytest
import yaml
from project import ROOT, Project
from snakemake.cli import parse_args

from conveyor import __version__

CI = (ROOT / ".ci/run").read_text()
PAGES = [*ROOT.glob("docs/guides/*.md"), *ROOT.glob("workflow/rules/**/*.md")]
GUIDES = ("CONTRIBUTING.md", "README.md", *(str(file.relative_to(ROOT)) for file in PAGES))


@pytest.mark.parametrize(
    ("guide", "pattern", "folder", "least"),
    [("CONTRIBUTING.md", r"`([\w./*]+/[\w./*]+)`", ".", 10), ("config/README.md", r"`(\w+\.yaml)`", "config/**", 3)],
)
def test_files_that_a_guide_names_exist(guide, pattern, folder, least):
    names = re.findall(pattern, (ROOT / guide).read_text())
    named = {name for name in names if not re.search("FLOOR|STAGE|NAME|SECTION|^(figures|results)/", name)}
    assert len(named) > least
    assert [name for name in sorted(named) if not list(ROOT.glob(f"{folder}/{name}"))] == []


@pytest.mark.parametrize("guide", GUIDES)
def test_snakemake_takes_the_commands_of_a_guide(guide):
    """Options with several values would swallow a target that follows them."""
    text = (ROOT / guide).read_text().replace("\\\n", " ")
    for block in re.findall(r"```bash\n(.*?)```", text, re.DOTALL):
        for command in re.findall(r"^(?:\S*/)?snakemake (?!--version)(.*)", block, re.MULTILINE):
            words = shlex.split(command, comments=True)
            if "workflow/profiles/slurm" in words:
                pytest.importorskip("snakemake_executor_plugin_slurm", reason="an extra that the guide installs")
            _, parsed = parse_args(words)
            targets = {word for word in words if re.fullmatch(r"(figures|results|docs)/.*(?<!yaml)", word)}
            assert targets <= set(parsed.targets), command


def anchors(page):
    """The anchors that a forge gives the headings of a page."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", [*ROOT.glob("docs/guides/*.md"), ROOT / "README.md"], ids=lambda page: page.stem)
def test_a_guide_can_be_read_where_it_lies(page):
    """No markup of Jinja or Sphinx outside code, and every link leads to a file of the repository."""
    text = re.sub(r"```\w+\n.*?```", "", page.read_text(), flags=re.DOTALL)
    assert re.findall(r"{%.*|{{.*|^:::.*|```{.*", text, re.MULTILINE) == []
    for link in re.findall(r"\]\((?!http)([^)\s]+)\)", text):
        path, _, anchor = link.partition("#")
        target = page.parent / path if path else page
        assert target.exists(), link
        assert not anchor or anchor in anchors(target), link


def test_pre_commit_checks_what_ci_does():
    hooks = yaml.safe_load((ROOT / ".pre-commit-config.yaml").read_text())["repos"][0]["hooks"]
    commands = re.search(r'step "format and lint"\n(.*?)\n\n', CI, re.DOTALL)[1].replace('"$bin/', "").replace('"', "")
    assert [hook["entry"] for hook in hooks] == commands.splitlines()
    assert {hook["language"] for hook in hooks} == {"system"}


def github_workflow(name):
    return yaml.safe_load((ROOT / f".github/workflows/{name}.yml").read_text())


@pytest.mark.parametrize("name", ["ci", "pages"])
def test_github_uses_pinned_actions(name):
    steps = [step for job in github_workflow(name)["jobs"].values() for step in job["steps"]]
    assert all(re.fullmatch(r"[\w/-]+@v\d+\.\d+\.\d+", step["uses"]) for step in steps if "uses" in step)


def test_github_runs_the_same_script_on_all_versions_of_python():
    job = github_workflow("ci")["jobs"]["ci"]
    assert [step["run"] for step in job["steps"] if "run" in step] == [".ci/run"]
    versions = job["strategy"]["matrix"]["python"]
    newest = int(versions[-1].split(".")[1])
    assert versions == [f"3.{minor}" for minor in range(11, newest + 1)]
    assert f"Python {versions[0]} to {versions[-1]}" in (ROOT / "README.md").read_text()
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert project["requires-python"] == f">={versions[0]},<3.{newest + 1}"
    assert {f"Programming Language :: Python :: {version}" for version in versions} <= set(project["classifiers"])


@pytest.mark.long
def test_github_publishes_the_site_that_the_config_makes(tmp_path):
    """The commands of the release workflow, and the folder that it uploads."""
    actions = github_workflow("pages")
    assert actions[True]["release"] == {"types": ["published"]}  # YAML reads the key `on` as true
    steps = actions["jobs"]["build"]["steps"]
    *_, make = [step["run"] for step in steps if "run" in step]
    (path,) = [step["with"]["path"] for step in steps if "path" in step.get("with", {})]
    run = Project(ROOT).called("--dry-run", "--directory", str(tmp_path), path, *make.split()[2:])
    assert run.returncode == 0, run.stdout
    for target in ("site", "article", "companion"):
        assert re.search(rf"^{target} +1$", run.stdout, re.MULTILINE)


def test_all_files_name_one_version():
    assert yaml.safe_load((ROOT / "CITATION.cff").read_text())["version"] == __version__
    assert f"Version {__version__} " in yaml.safe_load((ROOT / "codecheck.yml").read_text())["source"]
    assert re.findall(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)[0] == __version__


def test_the_other_snakefile_plans_the_same(built):
    """workflow/Snakefile, which the catalogue uses."""
    plans = [
        built.snakemake("--dry-run", "--forceall", *options) for options in ((), ("--snakefile", "workflow/Snakefile"))
    ]
    stats = [sorted(run.stdout.split("Job stats:")[1].split("\n\n")[0].splitlines()) for run in plans]
    assert stats[0] == stats[1]


@pytest.mark.long
def test_breakpoint_works_in_a_job(edited):
    """As the guide says: the job keeps the terminal of Snakemake."""
    project = edited(
        "scripts/conveyor_pipeline/paper/figures/fig03.py", "    figure = ", "    breakpoint()\n    figure = "
    )
    target = ("--cores", "1", "--force", "figures/fig03.png", *project.configfile())
    run = project.given_to(subprocess.run, *target, input="p 40 + 2\nc\n")
    assert run.returncode == 0, run.stdout
    assert "(Pdb) 42" in run.stdout


def test_dry_runs_say_why_a_job_runs(built):
    """As README and guides promise; the profile must not hide it."""
    run = built.snakemake("figures/fig03.pdf", "--dry-run", "--forcerun", "plot")
    assert "reason: Forced execution" in run.stdout


def test_a_stage_runs_without_snakemake(built, monkeypatch):
    """The lines of the guide compute what the rule has written."""
    built.make_in_process("results/lyapunov/spectrum.parquet")
    guide = (ROOT / "docs/guides/running.md").read_text()
    run, from_config = re.findall(r"```python\n(.*?)```", guide, re.DOTALL)
    monkeypatch.chdir(built.folder)
    names = {}
    exec(run, names)
    written = pd.read_parquet("results/lyapunov/spectrum.parquet")
    assert list(names["columns"]) == list(written)
    assert np.array_equal(names["columns"]["lambda_1"], written.lambda_1, equal_nan=True)
    exec(from_config, names)
    assert list(names["settings"]) == list(written.attrs)
