"""The keys of the config for the documentation, from its JSON Schema and from the comments of the default files."""

import re
from collections.abc import Iterator
from typing import NamedTuple

from ruamel.yaml import YAML
from ruamel.yaml.nodes import CollectionNode, MappingNode, Node

from conveyor_pipeline.config.schema import options_of

QUOTED = re.compile(r"\"[^\"]*\"|'[^']*'")


class Key(NamedTuple):
    """A key of the schema; NAME stands for a name of the user's choice, [] for a list item."""

    path: tuple[str, ...]
    allowed: str
    unit: str
    description: str


class FileKey(NamedTuple):
    """A key of a file: its value as text ("" for a block of keys), and the comments beside and above it."""

    path: tuple[str, ...]
    value: str
    beside: str
    above: str


def describe_range(schema: dict) -> str:
    """The range of a number in words."""
    low, high = (schema.get(end, schema.get(f"exclusive{end.capitalize()}")) for end in ("minimum", "maximum"))
    ends = "[" if "minimum" in schema else "(", "]" if "maximum" in schema else ")"
    if high is None:
        return f"number {'≥' if 'minimum' in schema else '>'} {low:g}"
    return f"number in {ends[0]}{low:g}, {high:g}{ends[1]}"


def describe_option(schema: dict) -> str:
    """One of several forms of a value in words; a mapping by its keys."""
    described = describe_values(schema)
    return f"{{{', '.join(schema['properties'])}}}" if described == "keys below" else described


def describe_values(schema: dict) -> str:
    """The allowed values of a key in words."""
    options = options_of(schema)
    if len(options) > 1:
        return ", or ".join(describe_option(option) for option in options)
    match options[0]:
        case {"patternErrorMessage": expected}:
            return expected
        case {"enum": words}:
            return ", ".join(words)
        case {"const": word}:
            return word
        case {"type": ["number", _]}:
            return describe_range(options[0])
        case {"type": "integer"}:
            return f"whole {describe_range(options[0])}"
        case {"type": "array", "prefixItems": items}:
            return f"list of {', '.join(describe_values(item) for item in items)}"
        case {"type": "array", "items": item}:
            return f"list; each item: {describe_values(item)}"
        case {"type": "object", "properties": keys} if keys.keys() == {"start", "stop", "num"}:
            return "{start, stop, num}"
        case {"type": "boolean"}:
            return "true or false"
        case {"type": "null"}:
            return "null"
    return "keys below"


def unit_of(schema: dict) -> str:
    """The unit of a number, or of the numbers in a list or range; "" for none."""
    for option in options_of(schema):
        inner = option.get("items") or option.get("properties", {}).get("start")
        if unit := option.get("unit") or (unit_of(inner) if inner else ""):
            return unit
    return ""


def list_keys(schema: dict, path: tuple[str, ...] = ()) -> Iterator[Key]:
    """All keys of the schema, in its order."""
    (inner, *further) = options_of(schema)
    allowed = describe_values(schema)
    properties = inner.get("properties", {})
    if path != ("model",) and properties.keys() >= {"acceleration", "mass"}:
        yield Key(path, "keys of `model`", "", schema["description"])
    elif properties and allowed == "keys below":
        for name, item in properties.items():
            yield from list_keys(item, (*path, name))
    elif allowed == "keys below":
        entry = inner.get("additionalProperties") or next(iter(inner["patternProperties"].values()))
        yield from list_keys(entry, (*path, "NAME"))
    elif not further and allowed == "list; each item: keys below":
        yield from list_keys(inner["items"], (*path, "[]"))
    else:
        yield Key(path, allowed, unit_of(schema), schema["description"])


def comment_of(line: str) -> str:
    """The comment of a line, after a value or alone; "" for none."""
    match = re.search(r"(?:^|\s)#\s*(.*)$", QUOTED.sub(lambda quoted: "_" * len(quoted[0]), line))
    return line[match.start(1) :].strip() if match else ""


def comment_above(lines: list[str], line: int) -> str:
    """The comment lines directly above a line with the same indentation, joined."""
    depth = len(lines[line]) - len(lines[line].lstrip())
    first = line
    while first and lines[first - 1].startswith(" " * depth + "#"):
        first -= 1
    return " ".join(comment_of(text) for text in lines[first:line])


def parse_file(text: str) -> Iterator[FileKey]:
    """All keys in the text of a YAML file. Comments belong to the first key of their line."""
    lines = text.splitlines()

    def parse_node(node: Node, path: tuple[str, ...]) -> Iterator[FileKey]:
        for key, value in node.value if isinstance(node, MappingNode) else ():
            line, column = key.start_mark.line, key.start_mark.column
            is_block = isinstance(value, CollectionNode) and not value.flow_style
            source = "" if is_block else " ".join(text[value.start_mark.index : value.end_mark.index].split())
            is_first = not lines[line][:column].strip()
            comments = (comment_of(lines[line]), comment_above(lines, line)) if is_first else ("", "")
            yield FileKey((*path, key.value), source, *comments)
            # The value of an alias is at its anchor, elsewhere in the file.
            if value.start_mark.index > key.start_mark.index:
                yield from parse_node(value, (*path, key.value))

    yield from parse_node(YAML(typ="safe").compose(text), ())
