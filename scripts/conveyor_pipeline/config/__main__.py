"""Check config/config.yaml and overlays: python -m conveyor_pipeline.config [--show] FILE …

With --show, print the whole config that results, with the unit and the origin of each value.
"""

import argparse
import json
import os
import signal
import sys
from collections.abc import Iterator

from conveyor_pipeline.config import ConfigError, load_config
from conveyor_pipeline.config.derived import origins_of
from conveyor_pipeline.config.errors import format_key
from conveyor_pipeline.config.files import DEFAULT_FILES, USER_FILE, find_lines
from conveyor_pipeline.config.schema import schema_at, unit_of


def values_of(value: object, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], object]]:
    """The values of a config with their paths; a list is a value."""
    if isinstance(value, dict) and value:
        for key, item in value.items():
            yield from values_of(item, (*path, key))
    else:
        yield path, value


def with_unit(path: tuple[str, ...], value: object) -> str:
    """A value as JSON, with the unit of its key; the schema gives the unit of a list at its first item."""
    values, place = (value, (*path, 0)) if isinstance(value, list) else ([value], path)
    unit = unit_of(schema_at(place)) if values and isinstance(values[0], int | float) else ""
    return f"{json.dumps(value, ensure_ascii=False)} {unit if unit != '1' else ''}".rstrip()


def origin_of(path: tuple[str, ...], lines: dict[tuple[str | int, ...], str]) -> str:
    """FILE:LINE of a key, of the dimensionless value that it follows from, or of the nearest key above it."""
    dimensionless = ((*path[:end], "dimensionless", *path[end:]) for end in range(1, len(path)))
    above = (path[:end] for end in range(len(path) - 1, 0, -1))
    return next(lines[candidate] for candidate in (path, *dimensionless, *above) if candidate in lines)


def show(config: dict, stated: dict, files: list[str]) -> Iterator[str]:
    """A line for each value: its key, the value, the file and line that it comes from, and a text with another unit.

    stated : what the overlays state, as they give it
    """
    lines = {path: line for file in files for path, line in find_lines(file).items()}
    texts = dict(values_of(stated))
    # The keys that a derived parameter of the model follows from are in its section.
    derived = {("model", name): (section,) for name, section in origins_of(config).items()}
    for path, value in values_of(config):
        source = derived.get(path, path)
        origin = origin_of(source, lines)
        if path in derived:
            origin += f": from the section {source[0]}"
        if isinstance(texts.get(path), str) and texts[path] != value:
            origin += f": {texts[path]}"
        yield f"{format_key(path)} = {with_unit(path, value)}    # {origin}"


if __name__ == "__main__":
    # End quietly if the reader of the output ends first, such as `head`.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    parser = argparse.ArgumentParser(prog="python -m conveyor_pipeline.config", description=__doc__)
    parser.add_argument("--show", action="store_true", help="print all values and their origins")
    parser.add_argument("file", nargs="*", help="an overlay, as for Snakemake's option --configfile")
    args = parser.parse_args()
    defaults, overlays = map(os.path.relpath, DEFAULT_FILES), [os.path.relpath(USER_FILE), *args.file]
    try:
        loaded = load_config(overlays, {})
    except ConfigError as error:
        sys.exit(str(error))
    print(
        "\n".join(show(loaded.merged, loaded.stated, [*defaults, *overlays])) if args.show else "The config is valid."
    )
