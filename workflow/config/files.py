"""Read and merge config files, and reject what Snakemake or YAML would misread.

Snakemake merges overlays, but forgets which file has a key first. YAML 1.1 keeps the last of two equal keys, and reads
050 as 40 and 1:30 as 90.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml
from snakemake.utils import update_config

from .errors import ConfigError, format_value

ROOT = Path(__file__).resolve().parents[2]
STAGES = (
    *("sweeps", "motion", "orbits", "dimensions", "fit", "sensitivity", "operating", "accuracy"),
    *("claims", "identification", "figures", "docs"),
)
DEFAULT_FILES = tuple(ROOT / f"config/{name}.yaml" for name in ("config", *STAGES))
MOST_VALUES, MOST_LEVELS = 12_000, 50  # of a file, anchors expanded: larger files take seconds to check
OCTAL = re.compile(r"[-+]?0[0-7_]+")
# Options of Snakemake that name config files and config values.
FILE_OPTIONS, VALUE_OPTIONS = ("--configfile", "--configfiles"), ("--config", "-C")


def check_size(text: str) -> str | None:
    """What makes a YAML text too large to be parsed, or None. The parser's own recursion would crash on deep levels."""
    levels, values = 0, 0
    for event in yaml.parse(text, Loader=yaml.CSafeLoader):
        values += isinstance(event, yaml.NodeEvent)
        levels += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
        line = event.start_mark.line + 1
        if levels > MOST_LEVELS:
            return f"{line}: has more than {MOST_LEVELS} nested levels; write a flatter file"
        if values > MOST_VALUES:
            return f"{line}: has more than {MOST_VALUES:,} values; write a long axis as {{start: …, stop: …, num: …}}"
    return None


def expanded_size(node: yaml.Node, known: dict[yaml.Node, tuple[int, int]]) -> tuple[int, int]:
    """Values and levels below a node with all anchors expanded; a node that contains itself counts once."""
    if node not in known:
        known[node] = (1, 1)
        children = node.value if isinstance(node, yaml.CollectionNode) else ()
        pairs = ((child,) if isinstance(child, yaml.Node) else child for child in children)
        sizes = [expanded_size(child, known) for pair in pairs for child in pair]
        known[node] = (1 + sum(values for values, _ in sizes), 1 + max((levels for _, levels in sizes), default=0))
    return known[node]


def misread(node: yaml.Node, key: str, above: tuple[yaml.Node, ...], seen: set[yaml.Node]) -> Iterator[str]:
    """ "LINE: fault" for all that YAML reads below a node otherwise than a reader expects.

    Parameters
    ----------
    key : the key of the node, as messages show it
    above : the nodes that contain this one
    seen : the nodes checked so far, which anchors may repeat
    """
    line = node.start_mark.line + 1
    if node in above:
        yield f"{line}: {key} contains itself by its anchor; write the values out"
    if node in seen:
        return
    seen.add(node)
    if isinstance(node, yaml.MappingNode):
        lines = {}
        for name, value in node.value:
            inner = f"{key}.{name.value}".lstrip(".")
            if isinstance(name, yaml.ScalarNode):
                here = name.start_mark.line + 1
                if name.value in lines:
                    yield f"{here}: {inner} stands in line {lines[name.value]} already; merge both"
                lines[name.value] = here
            yield from misread(value, inner, (*above, node), seen)
    elif isinstance(node, yaml.SequenceNode):
        for place, value in enumerate(node.value):
            yield from misread(value, f"{key}[{place}]", (*above, node), seen)
    elif node.tag in ("tag:yaml.org,2002:int", "tag:yaml.org,2002:float"):
        text = node.value
        if ":" in text:
            yield f"{line}: {key} = {text} is read as {yaml.safe_load(text)}, with base 60; write it without colons"
        elif OCTAL.fullmatch(text):
            yield f"{line}: {key} = {text} is read as {yaml.safe_load(text)}, an octal number; write it without the 0"


def read(file: str | Path) -> tuple[list[str], Any]:
    """All faults of a config file, one line each, and its content (None if it cannot be read)."""
    try:
        text = Path(file).read_text(encoding="utf-8")
        if fault := check_size(text):
            return [f"{file}:{fault}"], None
        node = yaml.compose(text, Loader=yaml.CSafeLoader)
        values, levels = expanded_size(node, {}) if node else (0, 0)
        if values > MOST_VALUES or levels > MOST_LEVELS:
            return [f"{file}: its anchors make {values:,} values on {levels} levels; write fewer anchors"], None
        content = yaml.load(text, Loader=yaml.CSafeLoader)
    except OSError as error:
        is_target = Path(file).parts[:1] in (("figures",), ("results",), ("docs",))
        remedy = (
            "put targets before --configfile, which takes all files that follow" if is_target else "give a config file"
        )
        return [f"{file}: {error.strerror}; {remedy}"], None
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        return [f"{file}:{line}: is not UTF-8 text ({error.reason}); save it as UTF-8"], None
    except (yaml.YAMLError, ValueError, TypeError) as error:
        mark = getattr(error, "problem_mark", None)
        reason = " ".join(str(getattr(error, "problem", error)).split())
        return [
            f"{file}:{f'{mark.line + 1}:' if mark else ''} is not YAML: {reason}; compare it with config/config.yaml"
        ], None
    if not isinstance(content, dict):
        return [f"{file}: holds no mapping of keys to values; begin with a section of config/config.yaml"], None
    return [f"{file}:{fault}" for fault in misread(node, "", (), set())], content


def read_all(files: list[str | Path]) -> list[dict]:
    """The contents of config files; ConfigError names all faults with file and line."""
    found = [read(file) for file in files]
    if faults := [fault for faults, _ in found for fault in faults]:
        raise ConfigError(faults)
    return [content for _, content in found]


def merge(*configs: dict) -> dict:
    """A new config: each of `configs` merged over the previous ones, as Snakemake merges overlays."""
    merged = {}
    for config in configs:
        update_config(merged, config)
    return merged


def as_first_written(value: Any, contents: list) -> Any:
    """A merged value with its keys in the order, and its numbers in the spelling, of the first file that has them.

    Parameters
    ----------
    value : the merged value
    contents : what the files have at this place, the first file first
    """
    if isinstance(value, dict):
        mappings = [content for content in contents if isinstance(content, dict)]
        keys = dict.fromkeys(key for mapping in mappings for key in mapping if key in value) | dict.fromkeys(value)
        return {key: as_first_written(value[key], [one[key] for one in mappings if key in one]) for key in keys}
    return next((content for content in contents if content == value), value)


def option_values(arguments: list[str], options: tuple[str, ...]) -> Iterator[str]:
    """The values that a command line gives to some options, which take all values up to the next option."""
    is_given = False
    for argument in arguments:
        if argument.startswith("-"):
            option, equals, value = argument.partition("=")
            if not argument.startswith("--"):
                option, value = argument[:2], argument[2:].removeprefix("=")
            is_given = option in options
            if is_given and (equals or value):
                yield value
        elif is_given:
            yield argument


def check_command_line(arguments: list[str]) -> None:
    """End Snakemake if an overlay or a --config value of its command line is wrong.

    Snakemake itself ends with a traceback, or does not name file and line.
    """
    faults = [fault for file in option_values(arguments, FILE_OPTIONS) for fault in read(file)[0]]
    faults += [
        f"--config {format_value(value)} is not KEY=VALUE with a top-level KEY such as prefix; put other values in an "
        "overlay file, and name it with --configfile"
        for value in option_values(arguments, VALUE_OPTIONS)
        if not re.fullmatch(r"[A-Za-z_]\w+=.*", value, re.DOTALL)
    ]
    if faults:
        raise SystemExit(str(ConfigError(faults)))
