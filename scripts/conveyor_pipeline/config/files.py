"""Read config files as YAML 1.2, and merge them.

Snakemake reads the files of --configfile as YAML 1.1, which keeps the last of two equal keys, reads 050 as 40 and 1:30
as 90, and 1e-8 as text. So overlays are read again here.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError
from ruamel.yaml.nodes import MappingNode, Node, SequenceNode
from snakemake.utils import update_config

from conveyor_pipeline.config.errors import ConfigError, format_key
from conveyor_pipeline.config.stages import FLOORS

ROOT = Path(__file__).resolve().parents[3]
DEFAULTS = ROOT / "config/defaults"
# The model first, then the floors in their order. Each floor has its own figures.
DEFAULT_FILES = (
    DEFAULTS / "model.yaml",
    *(file for floor in (*FLOORS, "pages") for file in sorted((DEFAULTS / floor).glob("*.yaml"))),
)
USER_FILE = ROOT / "config/config.yaml"  # an overlay of the defaults, below the files of --configfile


def read(file: str | Path) -> dict:
    """The content of a config file; ConfigError names the file, and the line if possible."""
    try:
        content = YAML(typ="safe").load(Path(file).read_text(encoding="utf-8"))
    except OSError as error:
        remedy = "name a config file (put targets before --configfile)"
        raise ConfigError([f"{file}: {error.strerror}; {remedy}"]) from error
    # LookupError and ValueError: a value that does not fit its tag, such as !!bool maybe or the date 2024-13-45.
    except (YAMLError, LookupError, ValueError) as error:
        mark = getattr(error, "problem_mark", None)
        place = f"{file}:{mark.line + 1}" if mark else file
        fault, is_double, _ = str(getattr(error, "problem", error)).partition(" with value")
        lines = Path(file).read_text(encoding="utf-8").splitlines()[mark.line :] if mark else []
        remedy = "; write spaces, not tabs" if any("\t" in line for line in lines[:1]) else ""
        remedy = "; merge both, or delete one" if is_double else remedy
        raise ConfigError([f"{place}: is not valid YAML: {fault}{remedy}"]) from error
    if not isinstance(content, dict):
        raise ConfigError([f"{file}: has no keys with values; begin with a section such as model"])
    return content


def find_lines(file: str | Path) -> dict[tuple[str | int, ...], str]:
    """FILE:LINE of the keys and list items of a config file, by their paths."""

    def lines_below(node: Node, path: tuple) -> Iterator[tuple[tuple, str]]:
        named = []
        if isinstance(node, MappingNode):
            # Merged keys (<<) first, because the node's own ones replace them.
            pairs = sorted(node.value, key=lambda pair: pair[0].value != "<<")
            named = [(key.value, key, value) for key, value in pairs]
        elif isinstance(node, SequenceNode):
            named = [(place, item, item) for place, item in enumerate(node.value)]
        for part, marked, value in named:
            if part == "<<":
                # Of several mappings, the first one that has a key counts.
                for merged in reversed(value.value) if isinstance(value, SequenceNode) else [value]:
                    yield from lines_below(merged, path)
            else:
                yield (*path, part), f"{file}:{marked.start_mark.line + 1}"
                yield from lines_below(value, (*path, part))

    return dict(lines_below(YAML(typ="safe").compose(Path(file).read_text(encoding="utf-8")), ()))


def walk(config: Any, path: tuple = ()) -> Iterator[tuple[tuple, Any]]:
    """All keys and list items of a config, as paths with their values."""
    items = config.items() if isinstance(config, dict) else enumerate(config) if isinstance(config, list) else ()
    for part, value in items:
        yield (*path, part), value
        yield from walk(value, (*path, part))


def name_lines(errors: Sequence[str], files: Sequence[str | Path], config: dict) -> list[str]:
    """Errors that begin with a key, each with the place of this key: FILE:LINE in the last file that has it.

    A key that "is missing" has the place of the section above it.

    config : values that replace those of the files, of the option --config; without files, of another workflow
    """
    in_files = {format_key(path): line for file in files for path, line in find_lines(file).items()}
    lines = in_files | ({format_key(path): "--config" for path, _ in walk(config)} if files else {})
    named = []
    for error in errors:
        key, _, fault = error.partition(" ")
        above = key.rpartition(".")[0]
        line = in_files.get(above, lines.get(above)) if fault.startswith("is missing") else lines.get(key)
        named.append(f"{line}: {error}" if line else error)
    return named


def merge(*configs: dict) -> dict:
    """A new config: each of `configs` merged over the previous ones, as Snakemake merges overlays.

    Keys have the order of the first config that has them.
    """
    merged = {}
    for config in configs:
        update_config(merged, config)
    return merged
