"""A copy of the project on a small config, and Snakemake run in it."""

import atexit
import copy
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import yaml

from conveyor_pipeline.config import canonical, load_config, problems
from conveyor_pipeline.config.entries import ENTRIES
from conveyor_pipeline.config.files import DEFAULT_FILES
from conveyor_pipeline.config.files import merge as merged
from conveyor_pipeline.config.stages import FLOORS

ROOT = Path(__file__).resolve().parents[1]
PARTS = ("Snakefile", "workflow", "profiles", "config", "scripts")

FIGURES = ("fig03", "fig08", "fig22")
TARGETS = tuple(f"figures/{figure}.pdf" for figure in FIGURES)
CAPTIONS = tuple(f"results/captions/{figure}.rst" for figure in FIGURES)
COARSE = {"axes": {"acceleration": {"num": 3}, "z0": {"num": 2}}, "duration": 0.1}
COARSE_PAIRS = {"axes": {"acceleration": {"num": 3}}, "duration": 0.1}
TINY = {
    "attractors": {"acceleration": {"num": 3}, "transient": 20, "strobes": 8},
    "sweeps": {"amplitudes": COARSE, "on_plate": {"axes": {"acceleration": {"num": 3}}}},
    "estimates": {"phase": COARSE_PAIRS},
}
# Tables of the chart on where to run a conveyor, which the default target makes for every config.
TINY_MACHINE = {
    "operating": {"acceleration": {"num": 4}, "resolution": 0.2, "starts": 16},
    "transit": {"acceleration": {"num": 2}, "longest": 2.0, "parts": 8},
    "drift": {"effort": 0.06},
}
# Default files below config/, without ".yaml": the model first.
CONFIG_FILES = tuple(file.relative_to(ROOT / "config").with_suffix("").as_posix() for file in DEFAULT_FILES)


def read_config(*files: str) -> dict:
    """The merged default config, or the merged config of some files."""
    return copy.deepcopy(merged(*map(content_of, files or CONFIG_FILES)))


def si_config() -> dict:
    """The default config in its one form, without dimensionless values."""
    return canonical(read_config())


@cache
def content_of(file: str) -> dict:
    """The content of a config file, read once: many tests read all of them."""
    return yaml.safe_load(config_file(file).read_text())


def config_file(name: str) -> Path:
    """The path of a file below config/."""
    return ROOT / f"config/{name}.yaml"


def small_config() -> dict:
    """The project's config with FIGURES and their tables only, on coarse axes."""
    config = merged(read_config(), TINY | (TINY_MACHINE if "machine" in FLOORS else {}))
    config["figures"] = {figure: config["figures"][figure] for figure in FIGURES}
    config["companion"]["maps"] = ["amplitudes"]
    config["uncertainty"]["claims"] = []
    tables = ("tables", "caption_tables")
    used = {table for entry in config["figures"].values() for key in tables for table in entry.get(key, {}).values()}
    used.add(f"critical/{config['sensitivity']['critical']}")
    for section in (*ENTRIES, "figures_on_request"):
        config[section] = {name: entry for name, entry in config[section].items() if f"{section}/{name}" in used}
    if "study" in FLOORS:
        config["map_check"] = {"maps": ["amplitudes"], "points": 4}
        reasons = config["scene_budget"]["reasons"]
        config["scene_budget"]["reasons"] = {table: reason for table, reason in reasons.items() if table in used}
    return config


def permuted(value):
    """The same config with all keys in reverse order and numbers in another spelling: 20 for 20.0, 11.0 for 11."""
    match value:
        case dict():
            return {key: permuted(value[key]) for key in reversed(value)}
        case list():
            return [permuted(item) for item in value]
        case bool():
            return value
        case float() if value.is_integer():
            return int(value)
        case int():
            return float(value)
    return value


# The folder of a Snakemake plugin, and the options with which it runs all jobs in Snakemake's own process.
IN_PROCESS_PLUGIN = str(ROOT / "tests/inprocess")
IN_PROCESS_OPTIONS = ("--cores", "1", "--jobs", "1", "--executor", "inprocess")


@cache
def forks() -> subprocess.Popen:
    """The process of snakemake_forks.py, which ends before this one."""
    process = subprocess.Popen(
        [sys.executable, str(ROOT / "tests/snakemake_forks.py")],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": IN_PROCESS_PLUGIN},
    )
    atexit.register(process.communicate)
    return process


def call_snakemake(*arguments: str, folder: Path = ROOT) -> subprocess.CompletedProcess:
    """Run Snakemake in a folder; stdout contains its output and the output of its jobs."""
    with tempfile.NamedTemporaryFile("r", encoding="utf-8") as output:
        command = {"arguments": arguments, "folder": str(folder), "environment": clean_environment()}
        print(json.dumps(command | {"output": output.name}), file=forks().stdin, flush=True)
        return subprocess.CompletedProcess(arguments, int(forks().stdout.readline()), output.read())


def clean_environment() -> dict[str, str]:
    """The environment without what a Snakemake that runs these tests has set."""
    return {name: value for name, value in os.environ.items() if not name.startswith("SNAKEMAKE")}


@dataclass(frozen=True)
class Project:
    """A copy of the project in `folder`, with an overlay of its config."""

    folder: Path
    overlay: dict = field(default_factory=dict)
    environment: dict[str, str] = field(default_factory=dict)  # in addition to the environment of the tests

    def snakemake(self, *arguments: str) -> subprocess.CompletedProcess:
        """Run Snakemake on the overlay; stdout contains its output and the output of its jobs."""
        return self.called(*arguments, *self.configfile())

    def configfile(self) -> tuple[str, str]:
        """Write the overlay, and return the option that names it."""
        (self.folder / "overlay.yaml").write_text(yaml.safe_dump(self.overlay, sort_keys=False))
        return "--configfile", "overlay.yaml"

    def called(self, *arguments: str) -> subprocess.CompletedProcess:
        """Run Snakemake with these arguments: in a new process if the project has an environment of its own."""
        if self.environment:
            return self.given_to(subprocess.run, *arguments, check=False)
        return call_snakemake(*arguments, folder=self.folder)

    def started(self, *arguments: str) -> subprocess.Popen:
        """Start Snakemake with these arguments in a new process group, as a terminal does.

        If nohup started the tests, Snakemake would inherit that SIGHUP is ignored.
        """

        def heed_the_terminal():
            signal.signal(signal.SIGHUP, signal.SIG_DFL)

        return self.given_to(subprocess.Popen, *arguments, start_new_session=True, preexec_fn=heed_the_terminal)

    def given_to(self, function, *arguments: str, **options):
        """Call a function of `subprocess` with the command line of Snakemake and these arguments."""
        return function(
            [sys.executable, "-m", "snakemake", *arguments],
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env=clean_environment() | self.environment,
            **options,
        )

    def make(self, *targets: str) -> None:
        run = self.snakemake(*targets)
        assert run.returncode == 0, run.stdout

    def make_in_process(self, *targets: str) -> None:
        """As `make`, in a fifth of the processor time: Python starts once, not once per job."""
        self.make(*IN_PROCESS_OPTIONS, *targets)

    def planned(self, *targets: str) -> dict[str, int]:
        """Number of jobs by rule that a dry run announces."""
        run = self.snakemake("--dry-run", *targets)
        assert run.returncode == 0, run.stdout
        if "Nothing to be done" in run.stdout:
            return {}
        stats = run.stdout.split("Job stats:")[1].split("\n\n")[0]
        jobs = {rule: int(count) for rule, count in re.findall(r"^(\w+)\s+(\d+)$", stats, re.MULTILINE)}
        jobs.pop("total")
        return jobs

    def under(self, overlay: dict) -> "Project":
        """The same folder with another overlay."""
        return Project(self.folder, overlay, self.environment)


def load(overlay: dict) -> dict:
    """The config of an overlay, as the Snakefile makes it."""
    return load_config([], overlay).config


def dry_run(overlay: dict, folder: Path, *targets: str) -> subprocess.CompletedProcess:
    """A dry run of the project with an overlay, which is written to `folder`."""
    file = folder / "mine.yaml"
    file.write_text(yaml.safe_dump(overlay, sort_keys=False))
    return Project(ROOT).called("--dry-run", *targets, "--configfile", str(file))


def assert_refused(run: subprocess.CompletedProcess, message: str) -> None:
    """Assert that Snakemake has failed with a message, and has said little else."""
    assert run.returncode != 0
    assert message in run.stdout
    assert len(run.stdout.splitlines()) <= 10


def assert_reported(overlay: dict, message: str) -> None:
    """Assert that an overlay has an error with this message, and that all errors are readable."""
    lines = problems(merged(read_config(), overlay))
    assert any(message in line for line in lines), lines
    assert all(line.isprintable() for line in lines)


def copy_project(folder: Path) -> Path:
    """Copy the project to `folder`, with the small config and without claims, which need more tables."""
    for part in PARTS:
        source = ROOT / part
        if source.is_dir() and not source.is_symlink():
            shutil.copytree(source, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy2(source, folder / part, follow_symlinks=False)
    for file in CONFIG_FILES[1:]:
        (folder / f"config/{file}.yaml").write_text("{}")
    (folder / "config/defaults/model.yaml").write_text(yaml.safe_dump(small_config(), sort_keys=False))
    for file in folder.glob("scripts/*/*/claims/claims.yaml"):
        file.write_text("{}")
    return folder
