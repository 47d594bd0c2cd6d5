"""The record of a build: a manifest of its files, and the sources, versions, machine and times behind them.

All builds of a config have the same manifest, so that two builds can be compared by their manifests. The provenance
differs from build to build; only the report shows it.
"""

import hashlib
import json
import os
import platform
import re
import subprocess
from collections.abc import Collection, Iterable
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path

import pandas as pd

from conveyor import record_rivals

ROOT = Path(__file__).resolve().parents[2]
UNKNOWN = "unknown"
HEAD = """\
# Results and figures with their SHA-256: equal on any number of cores, in any folder, time zone and locale.
# Check that all files are unchanged: sha256sum --quiet --check MANIFEST
# Compare two builds: diff MANIFEST OTHER_MANIFEST
"""
MAY_DIFFER = "# may differ between builds, because it contains measured times: "


def list_files(files: Iterable[str], timed: Collection[str]) -> str:
    """The manifest of `files`; those in `timed` contain measured times and get a comment, which sha256sum ignores."""

    def line(file: str) -> str:
        return MAY_DIFFER + file if file in timed else f"{hashlib.sha256(Path(file).read_bytes()).hexdigest()}  {file}"

    return HEAD + "".join(f"{line(file)}\n" for file in files)


def run_git(root: Path, *arguments: str) -> str | None:
    """The output of git for the repository in `root`, not a parent folder; None without a repository or git."""
    environment = os.environ | {"GIT_CEILING_DIRECTORIES": str(root.parent)}
    try:
        run = subprocess.run(["git", *arguments], cwd=root, env=environment, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return run.stdout.strip()


def sources(root: Path) -> dict[str, str | bool]:
    """The commit of the sources in `root`, and whether they are unchanged since."""
    commit, changes = run_git(root, "rev-parse", "HEAD"), run_git(root, "status", "--porcelain")
    return {"commit": commit or UNKNOWN, "clean": UNKNOWN if commit is None or changes is None else not changes}


def processor() -> str:
    """The name of the processor."""
    file = Path("/proc/cpuinfo")
    found = file.is_file() and re.search(r"^model name\s*: (.+)$", file.read_text(encoding="utf-8"), re.MULTILINE)
    return found[1] if found else platform.processor() or platform.machine() or UNKNOWN


def seconds(folder: Path) -> dict[str, float]:
    """Total wall time (s) of the jobs in each subfolder of a folder of benchmark files."""
    return {
        part.name: round(sum(float(pd.read_csv(file, sep="\t")["s"].sum()) for file in sorted(part.rglob("*.tsv"))), 1)
        for part in sorted(folder.iterdir())
        if part.is_dir()
    }


def versions() -> list[str]:
    """NAME==VERSION of Python and of all installed packages."""
    packages = {f"{package.name.lower()}=={package.version}" for package in metadata.distributions()}
    return [f"python=={platform.python_version()}", *sorted(packages)]


def make(files: list[str], timed: list[str], config: str, benchmarks: str, *, threads: int) -> dict[str, str]:
    """The manifest, and the provenance as JSON.

    config : hash of the canonical config
    benchmarks : folder of the benchmark files
    """
    provenance = {
        **sources(ROOT),
        "config_sha256": config,
        "made": datetime.now(UTC).isoformat(timespec="seconds"),
        "system": platform.platform(),
        "processor": processor(),
        "processors": os.cpu_count(),
        "threads": threads,
        "seconds": seconds(Path(benchmarks)),
        "versions": versions(),
        "rivals": record_rivals(),
    }
    return {"manifest": list_files(files, timed), "provenance": json.dumps(provenance, indent=2) + "\n"}
