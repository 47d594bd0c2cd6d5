"""The script of every rule that makes tables or pages: read its inputs, call one function, write what that returns.

A module of a stage has such a function, `make`, and TABLES, the schemas of the tables that it makes, by their kinds.
Its arguments are the named inputs of the rule (tables, texts, or paths of pictures; lists where the rule has lists),
its params other than NOT_FOR_THE_STAGE, and, if it has such arguments, `threads` and `progress`. It returns the content
of the output: the columns of a table (an iterator: of blocks of its rows), a text, bytes or a picture. For several
outputs it returns a mapping by their names, or a list if they have no names.
"""

import importlib
import inspect
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

from pipeline import fields, tables
from pipeline.rule_log import logged

# The module of the stage, the hash of its sources, and kind and settings that each input table must have, by its path.
NOT_FOR_THE_STAGE = STAGE, CODE, EXPECTED = "stage", "code", "expected"


def read(path: str, expected: dict[str, list]) -> Any:
    """An input: a table, a text, or the path of a picture."""
    if path.endswith(".parquet"):
        return tables.read(path, *expected[path])
    return path if path.endswith(".png") else Path(path).read_text(encoding="utf-8")


def read_inputs(paths: dict[str, Any], expected: dict[str, list]) -> dict[str, Any]:
    """The contents of inputs by their names."""
    return {
        name: read(path, expected) if isinstance(path, str) else [read(one, expected) for one in path]
        for name, path in paths.items()
    }


def contents(outputs: Any, made: Any) -> Iterator[tuple[str, str, Any]]:
    """Name, path and content of each output."""
    names = dict(outputs.items())
    if isinstance(made, list):
        yield from (("", path, content) for path, content in zip(outputs, made, strict=True))
    elif len(outputs) == 1:
        yield next(iter(names), ""), outputs[0], made
    else:
        if set(names) != set(made):
            raise ValueError(f"the rule has outputs {', '.join(names)}, but its stage returns {', '.join(made)}")
        yield from ((name, path, made[name]) for name, path in names.items())


def write(stage: ModuleType, name: str, path: str, content: Any, settings: dict) -> None:
    """Write one output of a stage."""
    if path.endswith(".parquet"):
        kind = name if name in stage.TABLES else next(iter(stage.TABLES))
        schema = [*(fields.AXES[axis] for axis in settings.get("axes", ())), *stage.TABLES[kind]]
        if isinstance(content, Iterator):
            tables.write_blocks(path, (tables.make(kind, schema, block, settings) for block in content))
        else:
            tables.write(path, tables.make(kind, schema, content, settings))
    elif isinstance(content, str):
        Path(path).write_text(content, encoding="utf-8")
    elif isinstance(content, bytes):
        Path(path).write_bytes(content)
    else:
        content.save(path, optimize=True)


def run(job: Any) -> None:
    """Run one job of Snakemake."""
    params = dict(job.params.items())
    stage = importlib.import_module(params[STAGE])
    arguments = read_inputs(dict(job.input.items()), params.get(EXPECTED, {}))
    arguments |= {name: value for name, value in params.items() if name not in NOT_FOR_THE_STAGE}
    threads = job.resources.get("cpus_per_task", job.threads)
    offered = {"threads": threads, "progress": " ".join([job.rule, *job.wildcards])}
    wanted = inspect.signature(stage.make).parameters
    arguments |= {name: value for name, value in offered.items() if name in wanted}
    for name, path, content in contents(job.output, stage.make(**arguments)):
        write(stage, name, path, content, params.get("settings", {}))


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        run(snakemake)
