"""The files of the config: what YAML reads otherwise than it is written, and the order in which keys are written first.

Snakemake merges overlays, but forgets which file named a key first, keeps the last of two equal keys, and reads 050 as
40 and 1:30 as 90, as YAML 1.1 says.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml
from snakemake.utils import update_config

# Lines of a refusal, so that it is ten with the four that Snakemake says around it.
LINES = 6
OCTAL = re.compile(r"[-+]?0[0-7_]+")


def misread(node: yaml.Node, key: str, above: tuple[yaml.Node, ...], seen: set[yaml.Node]) -> Iterator[tuple[int, str]]:
    """Line and fault of all that YAML reads below a node otherwise than it is written.

    Parameters
    ----------
    key : the key of the node, as it is told
    above : the nodes that hold this one
    seen : the nodes that have been looked at, which anchors may show again
    """
    line = node.start_mark.line + 1
    if node in above:
        yield line, f"{key} holds itself by its anchor; write out what is meant"
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
                    yield here, f"{inner} stands in line {lines[name.value]} already; merge both"
                lines[name.value] = here
            yield from misread(value, inner, (*above, node), seen)
    elif isinstance(node, yaml.SequenceNode):
        for place, value in enumerate(node.value):
            yield from misread(value, f"{key}[{place}]", (*above, node), seen)
    elif node.tag in ("tag:yaml.org,2002:int", "tag:yaml.org,2002:float"):
        text = node.value
        if ":" in text or OCTAL.fullmatch(text):
            kind = "with base 60" if ":" in text else "an octal number"
            read = f"{text} is read as {yaml.safe_load(text)}, {kind}"
            yield line, f"{key} = {read}; write it without {'colons' if ':' in text else 'the 0'}"


def read(file: str | Path) -> tuple[list[str], Any]:
    """All faults of a file of the config, one line each, and what it holds (None if it cannot be read)."""
    try:
        text = Path(file).read_text(encoding="utf-8")
        node = yaml.compose(text, Loader=yaml.CSafeLoader)
        content = yaml.load(text, Loader=yaml.CSafeLoader)
    except OSError as error:
        made = Path(file).parts[:1] in (("figures",), ("results",), ("docs",))
        remedy = (
            "name what is to be made before --configfile, which takes all that follows"
            if made
            else "give a file of the config"
        )
        return [f"{file}: {error.strerror}; {remedy}"], None
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
    return [f"{file}:{line}: {fault}" for line, fault in misread(node, "", (), set())], content


def merged(*contents: dict) -> dict:
    """Configs merged as Snakemake merges overlays, each over those before it; they stay as they are."""
    found = {}
    for content in contents:
        update_config(found, content)
    return found


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


def refusal(lines: list[str]) -> str:
    """The errors of a config in few lines."""
    if len(lines) < LINES:
        return "\n".join(["The config cannot be used:", *lines])
    told = LINES - 1
    return "\n".join([f"The config cannot be used; the first {told} errors, {len(lines) - told} more:", *lines[:told]])


def files_named(arguments: list[str]) -> list[str]:
    """The overlays that a command line of Snakemake names."""
    files, named = [], False
    for argument in arguments:
        if argument.startswith("-"):
            option, _, value = argument.partition("=")
            named = option in ("--configfile", "--configfiles")
            files += [value] if named and value else []
        elif named:
            files.append(argument)
    return files


def refuse_unreadable(arguments: list[str]) -> None:
    """End Snakemake if one of the overlays of its command line has faults, which are told.

    Snakemake reads overlays before the Snakefile, and ends with a traceback, or without file and line, if it cannot.
    """
    if faults := [fault for file in files_named(arguments) for fault in read(file)[0]]:
        raise SystemExit(refusal(faults))
