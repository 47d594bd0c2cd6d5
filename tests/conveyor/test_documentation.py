"""The documentation of the library: the diagram of imports, file names, and references in docstrings."""

import ast
import importlib.util
import io
import re
import tokenize
from functools import cache
from pathlib import Path

import pytest

from pipeline.imports import direct_imports

LIBRARY = Path(__file__).resolve().parents[2] / "scripts/conveyor"
README = (LIBRARY / "README.md").read_text()
FILES = sorted(LIBRARY.rglob("*.py"))


def part_of(file: Path) -> str:
    """The folder of a file, or the file itself at the top."""
    place = file.relative_to(LIBRARY).with_suffix("")
    return place.name if len(place.parts) == 1 else place.parent.as_posix()


def imports_between_parts() -> dict[str, set[str]]:
    """The other parts of the library that each part imports."""
    found = {part_of(file): set() for file in FILES if file.stem != "__init__"}
    for file in FILES:
        if file.stem != "__init__":
            used, _ = direct_imports(file, LIBRARY.parent, LIBRARY.name)
            found[part_of(file)] |= {part_of(other) for other in used} - {part_of(file)}
    return found


def behind(part: str, imports: dict[str, set[str]]) -> set[str]:
    """All parts that a part imports at any depth."""
    return imports[part].union(*(behind(other, imports) for other in imports[part]))


def diagram() -> str:
    """A line for each part, the lowest first, without the imports that others imply."""
    imports = imports_between_parts()
    lines = []
    for part in sorted(imports, key=lambda part: (len(behind(part, imports)), part)):
        direct = imports[part].difference(*(behind(other, imports) for other in imports[part]))
        lines.append(f"{part:<22} <- {', '.join(sorted(direct))}" if direct else part)
    return "\n".join(lines)


def test_the_picture_of_the_imports_is_true():
    (shown,) = re.findall(r"```text\n(.*?)\n```", README, re.DOTALL)
    assert shown == diagram()


def test_files_in_the_readme_exist():
    folder = LIBRARY
    for name in re.findall(r"`([\w/]+\.py)`", README):
        file = LIBRARY / name if (LIBRARY / name).is_file() else folder / name
        assert file.is_file() or name.startswith("tests/"), name
        folder = file.parent


@cache
def names_in(file: Path) -> set[str]:
    """All names that a module defines or uses, and for a package its modules."""
    found = {path.stem for path in file.parent.iterdir()} if file.stem == "__init__" else set()
    for node in ast.walk(ast.parse(file.read_text())):
        match node:
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name) | ast.Name(id=name) | ast.arg(arg=name):
                found.add(name)
            case ast.Attribute(attr=name) | ast.keyword(arg=str(name)):
                found.add(name)
            case ast.alias(name=name, asname=other):
                found.add(other or name)
            case ast.Constant(value=str(name)) if name.isidentifier():
                found.add(name)
    return found


def prose_in(file: Path) -> str:
    """The docstrings and comments of a module, without examples."""
    text = file.read_text()
    documented = (ast.Module, ast.FunctionDef, ast.ClassDef)
    found = [ast.get_docstring(node) or "" for node in ast.walk(ast.parse(text)) if isinstance(node, documented)]
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    found += [token.string for token in tokens if token.type == tokenize.COMMENT]
    return re.sub(r"^\s*>>>.*$", "", "\n".join(found), flags=re.MULTILINE)


MODULES: dict[str, list[Path]] = {}
for path in FILES:
    MODULES.setdefault(path.parent.name if path.stem == "__init__" else path.stem, []).append(path)
EVERYWHERE = set(MODULES).union(*map(names_in, FILES))


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(LIBRARY)))
def test_references_resolve(file):
    """`name`, module.name, and "see module"."""
    prose, own = prose_in(file), names_in(file)
    for module, name in re.findall(r"(?<![\w./])([a-z_]\w+)\.([A-Za-z_]\w+)", prose):
        if module in MODULES:
            assert any(name in names_in(other) | {"py"} for other in MODULES[module]), f"{module}.{name}"
        else:
            assert module in own or importlib.util.find_spec(module), f"{module}.{name}"
    for name in re.findall(r"`([A-Za-z_]\w*)`", prose):
        assert name in EVERYWHERE, name
    for name in re.findall(r"\b(?:see|as in) ([a-z]+_[a-z_]+)\b", prose):
        assert name in EVERYWHERE, name
