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

from conveyor_pipeline.common.rule_log import COMPILED

ROOT = Path(__file__).resolve().parents[3]
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
    match = file.is_file() and re.search(r"^model name\s*: (.+)$", file.read_text(encoding="utf-8"), re.MULTILINE)
    return match[1] if match else platform.processor() or platform.machine() or UNKNOWN


def compile_seconds(log: Path) -> float:
    """The time that a job has spent compiling (s), from its log; 0 if it compiled nothing."""
    match = re.search(rf"^{COMPILED}([\d.]+) s$", log.read_text(encoding="utf-8"), re.MULTILINE)
    return float(match[1]) if match else 0.0


def costs(benchmarks: Path, logs: Path) -> dict[str, dict[str, float | int]]:
    """Costs of the jobs in each subfolder of the folder of benchmark files, and of `everything`.

    They are the sum of the wall times (seconds), the part of this sum that was spent compiling, the largest memory of
    a job (MiB), and the number of jobs.
    """
    jobs = []
    for file in sorted(benchmarks.glob("*/**/*.tsv")):
        name = file.relative_to(benchmarks)
        benchmark = pd.read_csv(file, sep="\t", na_values="-")
        compiling = compile_seconds((logs / name).with_suffix(".log"))
        jobs.append((name.parts[0], benchmark["s"].sum(), compiling, benchmark["max_rss"].max()))
    table = pd.DataFrame(jobs, columns=["kind", "seconds", "compiling", "memory"])

    def total(rows: pd.DataFrame) -> dict[str, float | int]:
        seconds, compiling = (round(float(rows[name].sum()), 1) for name in ("seconds", "compiling"))
        return {"seconds": seconds, "compiling": compiling, "memory": float(rows.memory.max()), "jobs": len(rows)}

    return {**{str(kind): total(rows) for kind, rows in table.groupby("kind")}, "everything": total(table)}


def versions() -> list[str]:
    """NAME==VERSION of Python and of all installed packages."""
    packages = {f"{package.name.lower()}=={package.version}" for package in metadata.distributions()}
    return [f"python=={platform.python_version()}", *sorted(packages)]


def make(
    files: list[str], timed: list[str], config: str, benchmarks: str, logs: str, *, threads: int
) -> dict[str, str]:
    """The manifest, and the provenance as JSON.

    config : hash of the canonical config
    benchmarks, logs : folders of the benchmark files and of the logs
    """
    provenance = {
        **sources(ROOT),
        "config_sha256": config,
        "made": datetime.now(UTC).isoformat(timespec="seconds"),
        "system": platform.platform(),
        "processor": processor(),
        "processors": os.cpu_count(),
        "threads": threads,
        "costs": costs(Path(benchmarks), Path(logs)),
        "versions": versions(),
    }
    return {"manifest": list_files(files, timed), "provenance": json.dumps(provenance, indent=2) + "\n"}
