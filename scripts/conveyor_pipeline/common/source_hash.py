"""Content hashes of the code behind a script: its source, the modules that it imports, and the versions of packages.

Snakemake notices a changed script but not a changed module that the script imports. With this hash among its params, a
rule reruns if and only if the content of its code has changed. Imported by the Snakefile, so without slow imports.
"""

import hashlib
import sys
from collections.abc import Iterable
from functools import cache
from importlib import metadata
from pathlib import Path

from conveyor_pipeline.common.code_state import SCRIPTS
from conveyor_pipeline.common.imports import all_imports

# Without its last number: such versions only mend faults.
PYTHON = f"{sys.version_info.major}.{sys.version_info.minor}"
# Distributions whose version matters although no source imports them.
BEHIND = {"numba": ("llvmlite",), "matplotlib": ("pillow",)}


def closure(*scripts: str) -> tuple[list[Path], list[str]]:
    """The files below scripts/ and the packages that scripts import directly or indirectly, sorted."""
    files = [SCRIPTS / f"{script}.py" for script in scripts]
    for file in files:
        if not file.is_file():
            name = file.relative_to(SCRIPTS.parent)
            raise FileNotFoundError(f"{name} is missing, but a rule uses it; add it as CONTRIBUTING.md describes")
    return all_imports(files, SCRIPTS)


@cache
def distributions() -> dict[str, list[str]]:
    """Names of the distributions that provide each importable top-level name; finding them takes 0.2 s."""
    return metadata.packages_distributions()


@cache
def providers(package: str) -> list[str]:
    """Names of the distributions that provide a top-level name: in most cases, one of the same name."""
    try:
        return [metadata.distribution(package).name]
    except metadata.PackageNotFoundError:
        return distributions().get(package, [])


@cache
def version(distribution: str) -> str:
    """The version of an installed distribution; looking it up takes a millisecond."""
    return metadata.version(distribution)


@cache
def content(file: Path) -> bytes:
    """The content of a file, read once for all rules that depend on it."""
    return file.read_bytes()


def versions(packages: Iterable[str]) -> list[str]:
    """ "NAME==VERSION" of Python and of the distributions of all imported packages; "NAME: none" if not installed.

    Any of them may change a number or a picture.
    """
    lines = {f"python=={PYTHON}"}
    for package in packages:
        if package in sys.stdlib_module_names:
            continue
        names = providers(package)
        for name in [*names, *(behind for provider in names for behind in BEHIND.get(provider, ()))]:
            lines.add(f"{name}=={version(name)}")
        if not names:
            lines.add(f"{package}: none")
    return sorted(lines)


@cache
def source_hash(*scripts: str) -> str:
    """Hash of scripts, given as paths below scripts/ without ".py", and of everything that they import."""
    files, packages = closure(*scripts)
    digest = hashlib.sha256()
    for file in files:
        digest.update(f"{file.relative_to(SCRIPTS)}\0".encode() + content(file) + b"\0")
    for package in versions(packages):
        digest.update(f"{package}\0".encode())
    return digest.hexdigest()[:16]


def code_of(*scripts: str) -> str:
    """The param `code` of rules: the hash of scripts, and their names, so that a job can hash them again."""
    return " ".join([source_hash(*scripts), *scripts])
