"""What plot scripts, captions and findings ask for by name: read from their sources, without importing them."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

from jinja2 import Environment
from jinja2.meta import find_undeclared_variables

SCRIPTS = Path(__file__).resolve().parent.parent / "scripts"


class Names(NamedTuple):
    """What a function and all that it calls ask of a mapping: what it must hold, and what it may hold."""

    needed: frozenset[str]
    asked: frozenset[str]  # needed, or looked for before it is used
    texts: frozenset[str]
    patterns: frozenset[str]

    def knows(self, name: str) -> bool:
        """Whether a name is one of the texts, or put together of them."""
        found = (re.fullmatch(pattern, name) for pattern in self.patterns)
        return name in self.texts or any(self.texts.issuperset(match.groups()) for match in found if match)


class Module(NamedTuple):
    """Top-level definitions of a file, and where its imported names come from: (module, name or None)."""

    definitions: dict[str, ast.stmt]
    imported: dict[str, tuple[str, str | None]]


def file_of(module: str) -> Path:
    return SCRIPTS.joinpath(*module.split(".")).with_suffix(".py")


@cache
def read(module: str) -> Module:
    definitions, imported = {}, {}
    for node in ast.parse(file_of(module).read_bytes()).body:
        if isinstance(node, ast.FunctionDef):
            definitions[node.name] = node
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
                definitions.update({name.id: node for name in ast.walk(target) if isinstance(name, ast.Name)})
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                source = (inner, None) if file_of(inner).is_file() else (node.module, alias.name)
                imported[alias.asname or alias.name] = source
    return Module(definitions, imported)


def used(module: str, node: ast.AST) -> Iterator[tuple[str, str]]:
    """(module, name) of the definitions below scripts/ that a node names."""
    definitions, imported = read(module)
    if isinstance(node, ast.Name):
        source, name = imported.get(node.id, (module, node.id))
        if name and (source != module or name in definitions):
            yield source, name
    elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
        source, name = imported.get(node.value.id, ("", ""))
        if name is None:
            yield source, node.attr


def first_texts(module: str, function: ast.stmt, values: ast.expr) -> list[str]:
    """What a loop over `values` begins each of its rounds with, as far as it is written out in texts."""
    match values:
        case ast.Constant(value=str(text)):
            return [text]
        case ast.Tuple(elts=items) | ast.List(elts=items) | ast.Dict(keys=items):
            return [text for item in items for text in first_texts(module, function, item)[:1]]
        case ast.Call(func=ast.Attribute(value=mapping, attr="items")):
            return first_texts(module, function, mapping)
        case ast.Name() | ast.Attribute():
            assigned = [(module, node) for node in ast.walk(function) if isinstance(node, ast.Assign)]
            assigned = [(of, node) for of, node in assigned if ast.dump(node.targets[0]) == stored(values)]
            assigned += [(of, read(of).definitions.get(name)) for of, name in used(module, values)]
            return next(
                (first_texts(of, node, node.value) for of, node in assigned if isinstance(node, ast.Assign)), []
            )
    return []


def stored(name: ast.expr) -> str:
    """How the target of an assignment to this name is dumped."""
    return ast.dump(ast.Name(name.id, ast.Store())) if isinstance(name, ast.Name) else ""


@cache
def nodes_of(definition: ast.stmt) -> list[ast.AST]:
    """All nodes of a definition: each is looked through for many mappings."""
    return list(ast.walk(definition))


def keys_of_loops(module: str, function: ast.stmt, mapping: str) -> Iterator[str]:
    """The keys that loops `for key in …: mapping[key]` of a function need."""
    for node in nodes_of(function):
        heads = [node] if isinstance(node, ast.For) else getattr(node, "generators", [])
        if not heads:
            continue
        asked = [
            part.slice.id
            for part in ast.walk(node)
            if isinstance(part, ast.Subscript)
            and isinstance(part.slice, ast.Name)
            and getattr(part.value, "id", None) == mapping
        ]
        for head in heads:
            key = head.target.elts[0] if isinstance(head.target, ast.Tuple) else head.target
            if getattr(key, "id", None) in asked:
                yield from first_texts(module, function, head.iter)


@cache
def names_asked(module: str, function: str, mapping: str) -> Names:
    """What `function` of a module below scripts/ and all that it uses ask of the mapping that they call `mapping`."""
    needed, optional, texts, patterns = set(), set(), set(), set()
    seen, todo = set(), [read(module).imported.get(function, (module, function))]
    while todo:
        place = todo.pop()
        if place in seen or not file_of(place[0]).is_file() or place[1] not in read(place[0]).definitions:
            continue
        seen.add(place)
        needed.update(keys_of_loops(place[0], read(place[0]).definitions[place[1]], mapping))
        for node in nodes_of(read(place[0]).definitions[place[1]]):
            todo += used(place[0], node)
            match node:
                case ast.Subscript(ast.Name(id=name), ast.Constant(value=str(key))) if name == mapping:
                    needed.add(key)
                case ast.Compare(ast.Constant(value=str(key)), [ast.In() | ast.NotIn()], [ast.Name(id=name)]) if (
                    name == mapping
                ):
                    optional.add(key)
                case ast.Constant(value=str(value)):
                    texts.add(value)
                case ast.JoinedStr(values=parts):
                    written = [re.escape(part.value) if isinstance(part, ast.Constant) else r"(\w+)" for part in parts]
                    if any(isinstance(part, ast.Constant) for part in parts):
                        patterns.add("".join(written))
    return Names(frozenset(needed - optional), frozenset(needed | optional), frozenset(texts), frozenset(patterns))


@cache
def caption_functions() -> dict[str, str]:
    """The function of figures/captions.py that gives the numbers of a caption, by the name of the figure."""
    functions = [value.id for value in read("figures.captions").definitions["NUMBERS"].value.values]
    return dict(zip(keys_of("figures.captions", "NUMBERS"), functions, strict=True))


def names_of_figure(figure: str, mapping: str) -> list[Names]:
    """What the plot script and the caption of a figure ask for."""
    names = [names_asked(f"figures.plots.{figure}", "plot", mapping)]
    if figure in caption_functions():
        names.append(names_asked("figures.captions", caption_functions()[figure], mapping))
    return names


def has_make(stage: str) -> bool:
    """Whether the module of a stage has what its rule calls."""
    return "make" in read(stage).definitions


def keys_of(module: str, mapping: str) -> list[str]:
    """The keys of a mapping that a module below scripts/ writes out."""
    return [key.value for key in read(module).definitions[mapping].value.keys]


def compared(module: str, *functions: str) -> set[str]:
    """The names that functions of a module compare something with."""
    nodes = [node for function in functions for node in ast.walk(read(module).definitions[function])]
    sides = [side for node in nodes if isinstance(node, ast.Compare) for side in node.comparators]
    return {side.id for side in sides if isinstance(side, ast.Name)}


def names_of_template(file: Path) -> set[str]:
    """What a template of a caption asks for."""
    return find_undeclared_variables(Environment().parse(file.read_text(encoding="utf-8")))


@cache
def findings() -> dict[str, ast.FunctionDef]:
    """All functions of scripts/claims that give a Finding, by MODULE.FUNCTION."""
    return {
        f"{path.stem}.{name}": node
        for path in sorted((SCRIPTS / "claims").glob("about_*.py"))
        for name, node in read(f"claims.{path.stem}").definitions.items()
        if isinstance(node, ast.FunctionDef) and getattr(node.returns, "id", None) == "Finding"
    }


def names_of_finding(finding: str, mapping: str = "tables") -> Names:
    module, function = finding.split(".")
    return names_asked(f"claims.{module}", function, mapping)


def settings_of_finding(finding: str) -> tuple[list[str], list[str]]:
    """The settings that a finding takes besides its tables, and those of them without a default."""
    arguments = findings()[finding].args
    plain = [argument.arg for argument in arguments.args][1:]
    needed = plain[: len(plain) - len(arguments.defaults)] if arguments.defaults else plain
    words = [argument.arg for argument in arguments.kwonlyargs]
    needed = needed + [name for name, default in zip(words, arguments.kw_defaults, strict=True) if default is None]
    return plain + words, needed
