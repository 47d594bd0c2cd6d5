"""The script of rules that make tables, figures or pages: read the inputs, call a function `make`, write the results.

The module of a stage has the function `make`, and TABLES, the schemas of its tables by kind. The arguments of `make`
are

- the named inputs of the rule: tables, texts, or paths of pictures; lists where the rule has lists,
- the params of the rule, except for those that the function `stage` in workflow/rules/common.smk gives to this script,
- `settings`, `threads` and `progress`, if it has these arguments.

It returns the content of the output: a table or its columns, an iterator over the columns of blocks of its rows, a
text, bytes, or a picture. For several outputs, it returns a mapping by name, or a list if the outputs have no names.
"""

import importlib
import inspect
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

# Snakemake puts the folder of all packages last on the path; an installed copy of the library would come first.
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from conveyor_pipeline.common import csv_table, fields, tables
from conveyor_pipeline.common.rule_log import COMPILED, check_code, logged


def read(path: str, expected: dict[str, list]) -> Any:
    """An input: a table, a text, or the path of a picture."""
    if path.endswith(".parquet"):
        return tables.read(path, *expected[path])
    return path if path.endswith(".png") else csv_table.decode(Path(path).read_bytes(), path)


def read_inputs(paths: dict[str, Any], expected: dict[str, list]) -> dict[str, Any]:
    """The contents of inputs by name."""
    return {
        name: read(path, expected) if isinstance(path, str) else [read(item, expected) for item in path]
        for name, path in paths.items()
    }


def contents(outputs: Any, results: Any) -> Iterator[tuple[str, str, Any]]:
    """Name ("" for an output without a name), path and content of each output, from what `make` returned."""
    names = dict(outputs.items())
    if isinstance(results, list):
        yield from (("", path, content) for path, content in zip(outputs, results, strict=True))
    elif len(outputs) == 1:
        yield next(iter(names), ""), outputs[0], results
    else:
        if set(names) != set(results):
            raise ValueError(f"the rule has outputs {', '.join(names)}, but its stage returns {', '.join(results)}")
        yield from ((name, path, results[name]) for name, path in names.items())


def write(stage: ModuleType, name: str, path: str, content: Any, settings: dict) -> None:
    """Write one output of a stage."""
    if path.endswith(".parquet"):
        kind = name or next(iter(stage.TABLES))
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
    check_code(params.pop("code"))
    stage = importlib.import_module(params.pop("stage"))
    arguments = read_inputs(dict(job.input.items()), params.pop("expected")) | params
    optional = {"threads": job.threads, "progress": " ".join([job.rule, *job.wildcards])}
    if "settings" in params:
        optional["settings"] = arguments.pop("settings")
    parameters = inspect.signature(stage.make).parameters
    arguments |= {name: value for name, value in optional.items() if name in parameters}
    for name, path, content in contents(job.output, stage.make(**arguments)):
        write(stage, name, path, content, params.get("settings", {}))
    # Imported by the stage if it uses compiled functions.
    compilation = sys.modules.get("conveyor.solver.compilation")
    if compilation and (seconds := compilation.compile_seconds()):
        print(f"{COMPILED}{seconds:.1f} s", file=sys.stderr)


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        run(snakemake)
