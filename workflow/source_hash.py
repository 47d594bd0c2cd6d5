"""Content hashes of what a script runs: its own source, the modules it imports, the numerical packages.

Snakemake sees a changed script but not a changed module behind it. With such a hash among its params a rule runs
again exactly if something that it executes has changed in content.
"""

import ast
import hashlib
import platform
import sys
from collections.abc import Iterable, Iterator
from functools import cache
from importlib import metadata
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parent.parent / "scripts"
# Distributions that others work through.
BEHIND = {"numba": ("llvmlite",), "matplotlib": ("pillow",)}


def imported_names(path: Path) -> Iterator[tuple[str, str | None]]:
    """All (module, name) pairs that `path` imports, the name None for `import module`; relative ones made absolute."""
    package = path.relative_to(SCRIPTS).parent.parts
    for node in ast.walk(ast.parse(path.read_bytes(), filename=str(path))):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name, None
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else ()
            module = ".".join([*base, *([node.module] if node.module else [])])
            for alias in node.names:
                yield module, alias.name


def module_file(module: str) -> Path | None:
    """The file of a module below scripts/, or None if it is not one of ours."""
    place = SCRIPTS.joinpath(*module.split("."))
    for candidate in (place.with_suffix(".py"), place / "__init__.py"):
        if candidate.is_file():
            return candidate
    return None


@cache
def direct_imports(path: Path) -> tuple[frozenset[Path], frozenset[str]]:
    """Files below scripts/ and top-level names of other packages that `path` itself imports.

    A package's __init__ counts only where a name is taken from it, not where it merely leads to a module: importing
    conveyor.tables executes conveyor/__init__.py, but does not depend on the solver that is offered there.
    """
    files, packages = set(), set()
    for module, name in imported_names(path):
        file = (module_file(f"{module}.{name}") if name else None) or module_file(module)
        if file:
            files.add(file)
        else:
            packages.add(module.split(".")[0])
    return frozenset(files), frozenset(packages)


def closure(*scripts: str) -> tuple[list[Path], list[str]]:
    """Sorted files below scripts/ and packages that the scripts, named as in `source_hash`, need at any depth."""
    todo = [SCRIPTS / f"{script}.py" for script in scripts]
    files, packages = set(), set()
    while todo:
        path = todo.pop()
        if path in files:
            continue
        if not path.is_file():
            name = path.relative_to(SCRIPTS.parent)
            raise FileNotFoundError(
                f"{name} is missing, which a rule names; add it: CONTRIBUTING.md says what it holds"
            )
        files.add(path)
        more_files, more_packages = direct_imports(path)
        todo.extend(more_files)
        packages |= more_packages
    return sorted(files), sorted(packages)


@cache
def distributions() -> dict[str, list[str]]:
    """Names of the distributions that provide each importable top-level name."""
    return metadata.packages_distributions()


@cache
def version(distribution: str) -> str:
    """The version of an installed distribution; to look it up takes a millisecond."""
    return metadata.version(distribution)


@cache
def content(file: Path) -> bytes:
    """What a file holds: a process reads it once, for all rules that depend on it."""
    return file.read_bytes()


def versions(packages: Iterable[str]) -> list[str]:
    """ "NAME==VERSION" of Python and of all installed distributions behind imported names; "NAME: none" for the others.

    All of them may change a number or a picture; what belongs to Python itself has its version. numba compiles with
    llvmlite, and matplotlib draws with pillow: what these import is not ours to see.
    """
    found = {f"python=={platform.python_version()}"}
    for package in packages:
        if package in sys.stdlib_module_names:
            continue
        names = distributions().get(package, [])
        for name in [*names, *(behind for one in names for behind in BEHIND.get(one, ()))]:
            found.add(f"{name}=={version(name)}")
        if not names:
            found.add(f"{package}: none")
    return sorted(found)


def source_hash(*scripts: str) -> str:
    """Hash of scripts, named by their paths below scripts/ without ".py", and of everything that they import."""
    files, packages = closure(*scripts)
    digest = hashlib.sha256()
    for file in files:
        digest.update(f"{file.relative_to(SCRIPTS)}\0".encode() + content(file) + b"\0")
    for package in versions(packages):
        digest.update(f"{package}\0".encode())
    return digest.hexdigest()[:16]
