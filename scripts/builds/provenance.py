"""The record of a build: a manifest of its files, and the sources, versions, machine and times behind them.

The provenance differs from build to build; only the report shows it.
"""

import json
import os
import platform
import re
import subprocess
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path

import pandas as pd

from builds.manifest import list_files
from conveyor.methods import rivals

ROOT = Path(__file__).resolve().parents[2]
UNKNOWN = "unknown"


def git(root: Path, *arguments: str) -> str | None:
    """What git says of the repository in `root` itself, not of one around it; None if there is none, or no git."""
    environment = os.environ | {"GIT_CEILING_DIRECTORIES": str(root.parent)}
    try:
        run = subprocess.run(["git", *arguments], cwd=root, env=environment, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return run.stdout.strip()


def sources(root: Path) -> dict[str, str | bool]:
    """The commit of the sources in `root`, and whether nothing differs from it."""
    commit, changes = git(root, "rev-parse", "HEAD"), git(root, "status", "--porcelain")
    return {"commit": commit or UNKNOWN, "clean": UNKNOWN if commit is None or changes is None else not changes}


def processor() -> str:
    """The name of the processor, as far as the system tells it."""
    told = Path("/proc/cpuinfo")
    found = told.is_file() and re.search(r"^model name\s*: (.+)$", told.read_text(encoding="utf-8"), re.MULTILINE)
    return found[1] if found else platform.processor() or platform.machine() or UNKNOWN


def seconds(folder: Path) -> dict[str, float]:
    """Wall times (s) of the jobs whose benchmark files lie below a folder, summed by the folders in it."""
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

    Parameters
    ----------
    files : all results and figures
    timed : the files with measured times
    config : hash of the canonical config
    benchmarks : folder of the benchmark files
    threads : cores that Snakemake was given
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
        "rivals": rivals.record(),
    }
    return {"manifest": list_files(files, timed), "provenance": json.dumps(provenance, indent=2) + "\n"}
