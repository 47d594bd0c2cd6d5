"""The files of the config: what YAML reads otherwise than it is written, and the order in which keys are written first.

Snakemake merges overlays, but forgets which file named a key first, keeps the last of two equal keys, and reads 050 as
40 and 1:30 as 90, as YAML 1.1 says.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

OCTAL = re.compile(r"[-+]?0[0-7_]+")


def key_of(above: str, key: str) -> str:
    return f"{above}.{key}" if above else key


def misread(node: yaml.Node, key: str = "") -> Iterator[tuple[tuple[int, int], str]]:
    """Place (line, column) and fault of all that YAML reads below a node otherwise than it is written."""
    place = node.start_mark.line + 1, node.start_mark.column + 1
    if isinstance(node, yaml.MappingNode):
        lines = {}
        for name, value in node.value:
            inner = key_of(key, str(name.value))
            if isinstance(name, yaml.ScalarNode):
                line, column = name.start_mark.line + 1, name.start_mark.column + 1
                if name.value in lines:
                    yield (line, column), f"{inner} stands in line {lines[name.value]} already; merge both"
                lines[name.value] = line
            yield from misread(value, inner)
    elif isinstance(node, yaml.SequenceNode):
        for number, value in enumerate(node.value):
            yield from misread(value, f"{key}[{number}]")
    elif node.tag in ("tag:yaml.org,2002:int", "tag:yaml.org,2002:float"):
        text = node.value
        if ":" in text or OCTAL.fullmatch(text):
            kind = "with base 60" if ":" in text else "an octal number"
            read = f"{text} is read as {yaml.safe_load(text)}, {kind}"
            yield place, f"{key} = {read}; write it without {'colons' if ':' in text else 'the 0'}"


def read(file: str | Path) -> tuple[list[str], Any]:
    """All faults of a file of the config, one line each, and what it holds (None if it cannot be read)."""
    try:
        text = Path(file).read_text(encoding="utf-8")
        node = yaml.compose(text, Loader=yaml.CSafeLoader)
        content = yaml.load(text, Loader=yaml.CSafeLoader)
    except OSError as error:
        return [f"{file}: {error.strerror}; give a file of the config"], None
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        return [f"{file}:{line}: is not UTF-8 text ({error.reason}); save it as UTF-8"], None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        return [f"{file}:{mark.line + 1}: is not YAML: {error.problem}; compare it with config/config.yaml"], None
    except yaml.YAMLError as error:
        return [f"{file}: is not YAML: {' '.join(str(error).split())}; compare it with config/config.yaml"], None
    if not isinstance(content, dict):
        return [f"{file}: holds no mapping of keys to values; begin with a section of config/config.yaml"], None
    # Anchors show one fault below several keys, the first of which is told.
    faults = {}
    for place, fault in misread(node):
        faults.setdefault(place, fault)
    return [f"{file}:{line}: {faults[line, column]}" for line, column in sorted(faults)], content


def as_first_written(value: Any, contents: list) -> Any:
    """A merged value with its keys in the order, and its numbers in the spelling, in which `contents` have them first.

    Parameters
    ----------
    value : what Snakemake has merged
    contents : what the files hold at this place, the first file first
    """
    if isinstance(value, dict):
        mappings = [content for content in contents if isinstance(content, dict)]
        keys = dict.fromkeys(key for mapping in mappings for key in mapping if key in value) | dict.fromkeys(value)
        return {key: as_first_written(value[key], [one[key] for one in mappings if key in one]) for key in keys}
    return next((content for content in contents if content == value), value)
