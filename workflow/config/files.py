"""Read and merge config files, and reject what YAML 1.1 would misread.

YAML 1.1 keeps the last of two equal keys, and reads 050 as 40 and 1:30 as 90.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml
from snakemake.utils import update_config

from .errors import ConfigError, format_key, format_value
from .stages import STAGES

ROOT = Path(__file__).resolve().parents[2]
DEFAULT_FILES = tuple(ROOT / f"config/{name}.yaml" for name in ("config", *STAGES))
# Of a file, with anchors expanded: larger files take seconds to check.
MOST_CHARACTERS, MOST_VALUES, MOST_LEVELS = 1_000_000, 12_000, 50
OCTAL = re.compile(r"[-+]?0[0-7_]+")
# PyYAML's errors for text that its tag does not allow, as in !!bool maybe, 2024-13-45, or an integer of 5,000 digits.
UNREADABLE = (yaml.YAMLError, ValueError, LookupError, AttributeError)
SCALARS = yaml.SafeLoader("")


def size_fault(text: str) -> str | None:
    """What makes a YAML text too large to be parsed, or None. The parser's own recursion would crash on deep levels."""
    values, began, anchored = 0, [], {}
    for event in yaml.parse(text, Loader=yaml.CSafeLoader):
        line = event.start_mark.line + 1
        if isinstance(event, yaml.CollectionEndEvent):
            anchor, before = began.pop()
            anchored[anchor] = values - before
        elif isinstance(event, yaml.AliasEvent):
            values += anchored.get(event.anchor, 1)
        elif isinstance(event, yaml.NodeEvent):
            values += 1
            if isinstance(event, yaml.CollectionStartEvent):
                began.append((event.anchor, values))
        if len(began) > MOST_LEVELS:
            return f"{line}: has more than {MOST_LEVELS} nested levels; write a flatter file"
        if values > MOST_VALUES:
            remedy = "write a long axis as {start: …, stop: …, num: …}, and fewer anchors"
            return f"{line}: has more than {MOST_VALUES:,} values; {remedy}"
    if len(text) > MOST_CHARACTERS:
        return f"1: has more than {MOST_CHARACTERS:,} characters; write a shorter file"
    return None


def misread(node: yaml.Node, path: tuple[str | int, ...] = (), above: tuple[yaml.Node, ...] = ()) -> Iterator[str]:
    """ "LINE: fault" for each value below a node that YAML reads differently than expected; `above` are its parents."""
    key, line = format_key(path), node.start_mark.line + 1
    if node in above:
        yield f"{line}: {key} contains itself through an anchor; write the values out"
    elif isinstance(node, yaml.MappingNode):
        lines = {}
        for name, value in node.value:
            if isinstance(name, yaml.ScalarNode):
                inner, here = (*path, name.value), name.start_mark.line + 1
                if name.value in lines:
                    yield f"{here}: {format_key(inner)} is already set in line {lines[name.value]}; merge both"
                lines[name.value] = here
                yield from misread(name, inner)
                yield from misread(value, inner, (*above, node))
    elif isinstance(node, yaml.SequenceNode):
        for place, value in enumerate(node.value):
            yield from misread(value, (*path, place), (*above, node))
    elif fault := scalar_fault(node):
        yield f"{line}: {key} = {format_value(node.value)[1:-1]} {fault}"


def scalar_fault(node: yaml.ScalarNode) -> str | None:
    """The fault of a scalar that YAML cannot read, or reads differently than expected; None if it has none."""
    if node.tag.endswith(":merge"):
        return None
    try:
        value = SCALARS.construct_object(node)
    except UNREADABLE:
        return f"cannot be read as {node.tag.rpartition(':')[2]}; write a number, or text in quotes, without a tag"
    if node.tag.endswith((":int", ":float")) and (":" in node.value or OCTAL.fullmatch(node.value)):
        reason, sign = ("with base 60", "colons") if ":" in node.value else ("an octal number", "the 0")
        return f"is read as {value}, {reason}; write it without {sign}"
    return None


def read(file: str | Path) -> tuple[list[str], Any]:
    """All faults of a config file, one line each, and its content (None if it cannot be read)."""
    # A pipe, as in --configfile <(…), cannot be read again by Snakemake.
    if Path(file).exists() and not Path(file).is_file() and not Path(file).is_dir():
        return [f"{file}: is no regular file; save the config in one, and name that file"], None
    try:
        text = Path(file).read_text(encoding="utf-8")
    except OSError as error:
        return [f"{file}: {error.strerror}; name a config file (put targets before --configfile)"], None
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        return [f"{file}:{line}: is not UTF-8 text ({error.reason}); save it as UTF-8"], None
    return parse(text, str(file))


def parse(text: str, source: str) -> tuple[list[str], Any]:
    """All faults of a YAML text, one line each, and its content (None if it cannot be read).

    source : what messages call the text
    """
    try:
        if fault := size_fault(text):
            return [f"{source}:{fault}"], None
        node = yaml.compose(text, Loader=yaml.CSafeLoader)
        if faults := list(misread(node)) if node else []:
            return list(dict.fromkeys(f"{source}:{fault}" for fault in faults)), None
        content = yaml.load(text, Loader=yaml.CSafeLoader)
    except (*UNREADABLE, TypeError) as error:
        mark = getattr(error, "problem_mark", None)
        reason = " ".join(str(getattr(error, "problem", error)).split())
        place = f"{source}:{mark.line + 1}" if mark else source
        has_tab = mark and "\t" in "".join(text.splitlines()[mark.line : mark.line + 1])
        remedy = "write spaces in place of tabs" if has_tab else "compare it with config/config.yaml"
        return [f"{place}: is not YAML: {reason}; {remedy}"], None
    if not isinstance(content, dict):
        return [f"{source}: has no keys with values; begin with a section of config/config.yaml"], None
    return [], content


def read_all(files: list[str | Path]) -> list[dict]:
    """The contents of config files; ConfigError names all faults with file and line."""
    results = [read(file) for file in files]
    if faults := [fault for faults, _ in results for fault in faults]:
        raise ConfigError(faults)
    return [content for _, content in results]


def merge(*configs: dict) -> dict:
    """A new config: each of `configs` merged over the previous ones, as Snakemake merges overlays.

    Keys have the order of the first config that has them.
    """
    merged = {}
    for config in configs:
        update_config(merged, config)
    return merged


def changed_values(before: dict, after: dict) -> dict:
    """The keys of `after` with other values than `before`, level by level: what was merged over `before`."""
    changed = {}
    for key, value in after.items():
        if isinstance(value, dict) and isinstance(before.get(key), dict):
            if inner := changed_values(before[key], value):
                changed[key] = inner
        elif key not in before or before[key] != value:
            changed[key] = value
    return changed


def parse_texts(value: Any) -> Any:
    """A config value with numbers, true, false and null in place of texts that YAML reads as such.

    Snakemake leaves them as texts in nested values of its option --config, such as `model={damping: 0.2}`.
    """
    if isinstance(value, dict):
        return {key: parse_texts(item) for key, item in value.items()}
    if isinstance(value, list):
        return [parse_texts(item) for item in value]
    if not isinstance(value, str):
        return value
    node = yaml.ScalarNode(SCALARS.resolve(yaml.ScalarNode, value, (True, False)), value)
    return value if scalar_fault(node) else SCALARS.construct_object(node)
