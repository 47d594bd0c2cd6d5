"""The script of every rule that makes tables or pages: read its inputs, call one function, write what that returns.

A module of a stage has such a function, `make`, and TABLES, the schemas of the tables that it makes, by their kinds.
Its arguments are the named inputs of the rule (tables or texts, lists of them where the rule has lists), the params
beside those NOT_FOR_THE_STAGE, and, where it takes them, `threads` and `progress`. It returns what the one output
holds: the columns of a table (an iterator: of blocks of its rows), a text, bytes or a picture; of several outputs a
mapping by their names, or a list without names.
"""

import importlib
import inspect
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

from pipeline import fields, tables
from pipeline.rule_log import logged

# Its module, the hash of its sources, the kinds of its input tables by their names where a table's kind is not its
# name, and the settings that each of them must have been made from, by its path.
NOT_FOR_THE_STAGE = STAGE, CODE, KINDS, ASKED = "stage", "code", "kinds", "asked"


def read(path: str, kind: str, asked: dict[str, Any]) -> Any:
    """An input: a table, or a text."""
    if path.endswith(".parquet"):
        return tables.read(path, kind, asked[path])
    return Path(path).read_text(encoding="utf-8")


def read_inputs(paths: dict[str, Any], kinds: dict[str, Any], asked: dict[str, Any]) -> dict[str, Any]:
    """The contents of inputs by their names."""
    found = {}
    for name, path in paths.items():
        kind = kinds.get(name, name)
        if isinstance(path, str):
            found[name] = read(path, kind, asked)
        else:
            of_each = [kind] * len(path) if isinstance(kind, str) else kind
            found[name] = [read(one, its_kind, asked) for one, its_kind in zip(path, of_each, strict=True)]
    return found


def contents(outputs: Any, made: Any) -> Iterator[tuple[str, str, Any]]:
    """Name, path and content of each output."""
    names = dict(outputs.items())
    if isinstance(made, list):
        yield from (("", path, content) for path, content in zip(outputs, made, strict=True))
    elif len(outputs) == 1:
        yield next(iter(names), ""), outputs[0], made
    else:
        if set(names) != set(made):
            raise ValueError(f"outputs {', '.join(names)} of the rule, but {', '.join(made)} of the stage")
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
    """What a job of Snakemake does."""
    params = dict(job.params.items())
    stage = importlib.import_module(params[STAGE])
    arguments = read_inputs(dict(job.input.items()), params.get(KINDS, {}), params[ASKED])
    arguments |= {name: value for name, value in params.items() if name not in NOT_FOR_THE_STAGE}
    offered = {"threads": job.resources.cpus_per_task, "progress": " ".join([job.rule, *job.wildcards])}
    wanted = inspect.signature(stage.make).parameters
    arguments |= {name: value for name, value in offered.items() if name in wanted}
    for name, path, content in contents(job.output, stage.make(**arguments)):
        write(stage, name, path, content, params.get("settings", {}))


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        run(snakemake)
