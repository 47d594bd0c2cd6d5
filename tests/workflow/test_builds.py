"""Builds on other cores, in another folder, time zone and locale: equal except for files that the manifest names."""

import json
import os
import shutil
import subprocess

import pytest
from project import Project, copy_project, read_config

from conveyor_pipeline.common import provenance
from conveyor_pipeline.common.provenance import MAY_DIFFER
from conveyor_pipeline.config.stages import FLOORS

# The fastest of the figures that are drawn from measured times, and its files. Only the floor study measures times.
TIMED, TIMED_FILES = {}, set()
if "study" in FLOORS:
    TIMED = {
        "figures": {"scene_budget": read_config()["figures"]["scene_budget"]},
        "scene_budget": {"effort": 0.01},
    }
    TIMED_FILES = {"results/budget_times.parquet", "results/captions/scene_budget.rst"}
    TIMED_FILES |= {"figures/scene_budget.pdf", "figures/scene_budget.png"}
MANIFEST, PROVENANCE = "results/manifest.sha256", "results/provenance.json"
USES_UTF8 = "UTF" in (os.environ.get("LC_ALL") or os.environ.get("LANG") or "").upper()
ELSEWHERE = {"TZ": "ELSEWHERE-12:45", "LC_ALL": "C" if USES_UTF8 else "C.UTF-8"}


@pytest.fixture(scope="module")
def builds(built, tmp_path_factory):
    """Two complete builds of one config."""
    first = shutil.copytree(built.folder, tmp_path_factory.mktemp("builds") / "first", symlinks=True)
    second = copy_project(tmp_path_factory.mktemp("zweiter Ort für alles"))
    projects = Project(first, TIMED), Project(second, TIMED, ELSEWHERE)
    projects[0].make("--cores", "2")
    projects[1].make("--cores", "1", "all", "docs/companion.html")
    return projects


def made(project):
    """The contents of all results, figures and pages, by their paths."""
    # Results that other tests have made under another prefix are not part of this build.
    prefixes = [logs.parent.name for logs in (project.folder / "results").glob("*/logs")]
    others = [f"{part}/{prefix}/" for part in ("results", "figures") for prefix in prefixes]
    # The origin of the results differs between builds.
    aside = ("results/logs/", "results/benchmarks/", PROVENANCE, *others)
    files = [path for part in ("results", "figures", "docs") for path in (project.folder / part).rglob("*")]
    contents = {str(path.relative_to(project.folder)): path.read_bytes() for path in files if path.is_file()}
    return {name: content for name, content in contents.items() if not name.startswith(aside)}


@pytest.mark.long
def test_two_builds_differ_only_in_files_that_the_manifest_names(builds):
    first, second = map(made, builds)
    assert set(first) == set(second)
    digests = [json.loads((project.folder / PROVENANCE).read_text())["config_sha256"] for project in builds]
    assert digests[0] == digests[1]
    lines = first[MANIFEST].decode().splitlines()
    named = {line.removeprefix(MAY_DIFFER) for line in lines if line.startswith(MAY_DIFFER)}
    assert named == TIMED_FILES
    different = {name for name in first if first[name] != second[name]}
    assert different or not TIMED_FILES
    assert different <= named


def test_the_manifest_lists_all_files_except_pages_and_intermediate_tables(built):
    lines = (built.folder / MANIFEST).read_text().splitlines()
    listed = {line.split()[-1] for line in lines if not line.startswith("#")}
    assert set(made(built)) - listed == {
        MANIFEST,
        "docs/companion.html",
        "results/attractors/strobes.parquet",
    }
    assert listed <= set(made(built))


def test_a_changed_result_is_found_with_the_manifest(copied):
    """As the page "Choose what to run" describes."""
    folder = copied.folder
    check = ["sha256sum", "--quiet", "--check", MANIFEST]
    subprocess.run(check, cwd=folder, check=True)
    with (folder / "figures/fig08.pdf").open("ab") as file:
        file.write(b" ")
    run = subprocess.run(check, cwd=folder, capture_output=True, text=True, check=False)
    assert run.returncode != 0
    assert run.stdout == "figures/fig08.pdf: FAILED\n"


def test_provenance_is_complete_and_reruns_nothing(built):
    recorded = json.loads((built.folder / PROVENANCE).read_text())
    assert recorded["commit"] == recorded["clean"] == "unknown"
    assert len(recorded["config_sha256"]) == 64
    assert recorded["threads"] == 1
    assert recorded["costs"]["figures"]["jobs"] > 0
    names = {one.split("==")[0] for one in recorded["versions"]}
    assert {"python", "numpy", "numba", "matplotlib", "python-flint", "pymoo", "snakemake"} <= names
    assert built.planned("all") == {}


def test_costs_are_sums_over_the_benchmark_files_of_a_kind(tmp_path):
    """The time to compile comes from the log of each job; a job that compiled nothing has no such line."""
    benchmarks, logs = tmp_path / "benchmarks", tmp_path / "logs"
    jobs = {"sweeps/a": ("20.0\t300.0", "Compiled.\nTime to compile: 12.5 s\n"), "sweeps/b/0": ("10.0\t-", "")}
    for name, (measured, log) in (jobs | {"orbits/c": ("5.0\t400.0", "")}).items():
        for file in (benchmarks / f"{name}.tsv", logs / f"{name}.log"):
            file.parent.mkdir(parents=True, exist_ok=True)
        (benchmarks / f"{name}.tsv").write_text(f"s\tmax_rss\n{measured}\n")
        (logs / f"{name}.log").write_text(log)
    assert provenance.costs(benchmarks, logs) == {
        "orbits": {"seconds": 5.0, "compiling": 0.0, "memory": 400.0, "jobs": 1},
        "sweeps": {"seconds": 30.0, "compiling": 12.5, "memory": 300.0, "jobs": 2},
        "everything": {"seconds": 35.0, "compiling": 12.5, "memory": 400.0, "jobs": 3},
    }


def test_the_commit_belongs_to_the_sources(tmp_path):
    def git(*arguments):
        identity = ("-c", "user.name=A", "-c", "user.email=a@b.c")
        subprocess.run(["git", *identity, *arguments], cwd=tmp_path, check=True, capture_output=True)

    copy = tmp_path / "copy"
    copy.mkdir()
    (copy / "file").write_text("one")
    git("init")
    git("add", ".")
    git("commit", "--message", "one")
    found = provenance.sources(tmp_path)
    assert len(found["commit"]) == 40
    assert found["clean"] is True
    (copy / "file").write_text("two")
    assert provenance.sources(tmp_path) == {"commit": found["commit"], "clean": False}
    # A copy in a folder of another repository has no commit.
    assert provenance.sources(copy) == {"commit": "unknown", "clean": "unknown"}


@pytest.mark.long
def test_the_report_of_snakemake_shows_each_figure_with_its_caption(copied):
    project = copied
    project.make("--report", "report.html")
    report = (project.folder / "report.html").read_text(encoding="utf-8")
    captions = list((project.folder / "results/captions").glob("*.rst"))
    assert captions
    for caption in captions:
        assert f'"figures/{caption.stem}.png"' in report
        first_words = " ".join(caption.read_text(encoding="utf-8").split()[:4])
        assert f"<p>{first_words}" in report, caption.stem
        assert f"Drawn by scripts/conveyor_pipeline/paper/figures/{caption.stem}.py" in report
