"""The keys of the config for readers: what each may be, what the paper's config says, and the comments there."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, NamedTuple, NotRequired, get_args, get_origin, get_type_hints

import yaml
from typing_extensions import is_typeddict

from workflow.config_model import Config
from workflow.config_types import PARAMETERS, Allowed

# Parameters of the model that a mapping may hold without being said to hold those of `model`.
MOST_LISTED = 6
QUOTED = re.compile(r"\"[^\"]*\"|'[^']*'")


class Key(NamedTuple):
    """A key of the model; NAME stands for a name of the user's choice, [] for each of a list."""

    path: tuple[str, ...]
    allowed: str
    unit: str
    needed: bool


class Written(NamedTuple):
    """A key of a file: its value as it is written (nothing for a block of keys), the comments beside and above it."""

    path: tuple[str, ...]
    value: str
    beside: str
    above: str


# -- the model ---------------------------------------------------------------------------------------------------------


def bare(kind: Any) -> tuple[Any, Allowed | None]:
    """A type without its annotations, and what they say of its values."""
    said = None
    while get_origin(kind) in (Annotated, NotRequired):
        inner, *notes = get_args(kind)
        said = next((note for note in notes if isinstance(note, Allowed)), said)
        kind = inner
    return kind, said


def is_span(kind: Any) -> bool:
    return is_typeddict(kind) and set(kind.__annotations__) == {"start", "stop", "num"}


def allowed(kind: Any) -> Allowed:
    """What a type without keys of its own allows."""
    inner, said = bare(kind)
    if get_origin(inner) is list:
        items = allowed(get_args(inner)[0])
        return Allowed(f"{said.values if said else 'list, each'} {items.values}", items.unit)
    if said:
        return said
    if is_span(inner):
        ends = allowed(get_type_hints(inner, include_extras=True)["start"])
        return Allowed(f"{{start, stop, num}}, the ends each {ends.values}", ends.unit)
    options = [option for option in get_args(inner) if option is not type(None)]
    if any(is_span(bare(option)[0]) for option in options):
        values = allowed(options[0])
        return Allowed(f"{{start, stop, num}}, or {values.values}", values.unit)
    if len(options) < len(get_args(inner)):
        value = allowed(options[0])
        return Allowed(f"{value.values}, or null", value.unit)
    raise TypeError(f"nothing is said of the values of {kind}")


def keys(kind: Any = Config, path: tuple[str, ...] = (), needed: bool = True) -> Iterator[Key]:
    """All keys below a type, in the order of the model."""
    inner, _ = bare(kind)
    items = get_args(inner)
    if (
        path != ("model",)
        and is_typeddict(inner)
        and len(PARAMETERS.keys() & inner.__annotations__.keys()) > MOST_LISTED
    ):
        axes = ", an axis each: {start, stop, num}, or a list" if inner.__name__ == "Axes" else ""
        yield Key(path, f"keys of `model`{axes}", "", needed)
    elif is_typeddict(inner) and not is_span(inner):
        for name, of in get_type_hints(inner, include_extras=True).items():
            yield from keys(of, (*path, name), name in inner.__required_keys__)
    elif get_origin(inner) is dict:
        yield from keys(items[1], (*path, "NAME"), False)
    elif get_origin(inner) is list and is_typeddict(bare(items[0])[0]):
        yield from keys(items[0], (*path, "[]"), needed)
    else:
        yield Key(path, *allowed(kind), needed)


# -- the files ---------------------------------------------------------------------------------------------------------


def comment_of(line: str) -> str:
    """The comment at the end of a line, or that which is all of it."""
    found = re.search(r"(?:^|\s)#\s*(.*)$", QUOTED.sub(lambda quoted: "_" * len(quoted[0]), line))
    return line[found.start(1) :].strip() if found else ""


def above(lines: list[str], line: int) -> str:
    """The comment on whole lines directly above a line, as deep as it is."""
    depth = len(lines[line]) - len(lines[line].lstrip())
    first = line
    while first and lines[first - 1].startswith(" " * depth + "#"):
        first -= 1
    return " ".join(comment_of(text) for text in lines[first:line])


def written(text: str) -> Iterator[Written]:
    """All keys of a file in YAML that begin a line."""
    lines = text.splitlines()

    def below(node: yaml.Node, path: tuple[str, ...]) -> Iterator[Written]:
        for key, value in node.value if isinstance(node, yaml.MappingNode) else ():
            line, column = key.start_mark.line, key.start_mark.column
            is_block = isinstance(value, yaml.CollectionNode) and not value.flow_style
            if not lines[line][:column].strip():
                shown = "" if is_block else " ".join(text[value.start_mark.index : value.end_mark.index].split())
                yield Written((*path, key.value), shown, comment_of(lines[line]), above(lines, line))
            # What an alias stands for is written elsewhere.
            if value.start_mark.index > key.start_mark.index:
                yield from below(value, (*path, key.value))

    yield from below(yaml.compose(text), ())


def all_written(files: list[str]) -> list[Written]:
    """All keys of some files."""
    return [key for file in files for key in written(Path(file).read_text(encoding="utf-8"))]
