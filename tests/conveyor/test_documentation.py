"""The documentation of the library: file names, and references in docstrings."""

import ast
import importlib.util
import io
import re
import tokenize
from functools import cache
from pathlib import Path

import pytest

import conveyor

ROOT = Path(__file__).resolve().parents[2]
LIBRARY = ROOT / "scripts/conveyor"
REFERENCE_PAGE = ROOT / "workflow/templates/site/api_simulation.md"
README = (LIBRARY / "README.md").read_text()
FILES = sorted(LIBRARY.rglob("*.py"))


def test_files_in_the_readme_exist():
    folder = LIBRARY
    for name in re.findall(r"`([\w/]+\.py)`", README):
        file = LIBRARY / name if (LIBRARY / name).is_file() else folder / name
        assert file.is_file() or name.startswith("tests/"), name
        folder = file.parent


def test_the_reference_page_has_every_public_name_once():
    page = REFERENCE_PAGE.read_text().partition("## Supporting modules")[0]
    constants = [name for row in re.findall(r"^\|(.*?)\|", page, re.MULTILINE) for name in re.findall(r"`(\w+)`", row)]
    documented = re.findall(r"^\.\. auto\w+:: conveyor\.(\w+)$", page, re.MULTILINE)
    assert sorted(documented + constants) == sorted(conveyor.__all__)


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
    return re.sub(r"^\s*(>>>|\.\.\.).*$", "", "\n".join(found), flags=re.MULTILINE)


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
