"""The modules of this project that a module imports, found in its source without running it.

Python's modulefinder would take 3 s for all scripts at every start, this module takes 0.3 s; modulefinder also counts
each package on the way to a module as imported.
"""

import ast
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path


def statements(node: ast.AST) -> Iterator[ast.AST]:
    """All statements within a node. Expressions import nothing, and most of the time would go into them."""
    for part in ("body", "handlers", "orelse", "finalbody", "cases"):
        for inner in getattr(node, part, ()):
            yield inner
            yield from statements(inner)


def imported_names(file: Path, root: Path) -> Iterator[tuple[str, str | None]]:
    """All (module, name) pairs that a file below `root` imports; the name is None for `import module`."""
    package = file.relative_to(root).parent.parts
    for node in statements(ast.parse(file.read_bytes(), filename=str(file))):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name, None
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else ()
            module = ".".join([*base, *([node.module] if node.module else [])])
            for alias in node.names:
                yield module, alias.name


def module_file(module: str, root: Path) -> Path | None:
    """The file of a module below `root`, or None if there is none."""
    place = root.joinpath(*module.split("."))
    return next((file for file in (place.with_suffix(".py"), place / "__init__.py") if file.is_file()), None)


@cache
def public_names(stub: Path, root: Path) -> dict[str, Path]:
    """The files in which a package defines the names that its stub, __init__.pyi, offers."""
    files = ((name, module_file(module, root)) for module, name in imported_names(stub, root))
    return {name: file for name, file in files if name and file}


def file_of(module: str, name: str | None, root: Path) -> Path | None:
    """The file that `from module import name` depends on, or None if it is none below `root`."""
    file = module_file(f"{module}.{name}", root) if name else None
    package = module_file(module, root)
    if file is None and package and (stub := package.with_suffix(".pyi")).is_file():
        file = public_names(stub, root).get(name)
    return file or package


@cache
def direct_imports(file: Path, root: Path) -> tuple[frozenset[Path], frozenset[str]]:
    """The files of this project that a file imports, and the top-level names of all other packages.

    A package's __init__ counts only if it defines the name that is taken from it: `from conveyor.solver import model`
    does not depend on what conveyor/__init__.py offers, and `from conveyor import sweep` depends on the module of
    `sweep` alone, which conveyor/__init__.pyi names. Absolute imports begin in the folder `root`.
    """
    files, packages = set(), set()
    for module, name in imported_names(file, root):
        if source := file_of(module, name, root):
            files.add(source)
        else:
            packages.add(module.split(".")[0])
    return frozenset(files), frozenset(packages)


def all_imports(start: Iterable[Path], root: Path) -> tuple[list[Path], list[str]]:
    """The files that some files import at any depth, with these files, and the other packages; both sorted."""
    files, packages, waiting = set(), set(), list(start)
    while waiting:
        file = waiting.pop()
        if file not in files:
            files.add(file)
            more_files, more_packages = direct_imports(file, root)
            waiting.extend(more_files)
            packages |= more_packages
    return sorted(files), sorted(packages)
