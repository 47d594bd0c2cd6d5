# What all rules share: names of files, common params, and the functions that rules call with their wildcards.
import hashlib
import json
import math
import os
import re
import signal
from pathlib import Path

from scripts.docs.config_keys import all_written
from scripts.docs.config_keys import keys as config_keys
from scripts.report.pages import escape_label, figure_pages, notice
from workflow.config.schema import json_schema
from workflow.config.settings import (
    budgeted_entries,
    budgeted_tables,
    model_without_acceleration,
    scaling_cases,
    settings_of,
    tighter_claims,
)
from workflow.config.sharing import THREADS, plan
from workflow.config.tables import ON_REQUEST, TABLES, kind_of, resolve
from workflow.source_hash import SCRIPTS, closure, source_hash, versions

# Without huge pages: clearing one takes 5 to 14 ms on a virtual machine, and joining shards takes 8 % more memory with them.
os.environ.setdefault("MIMALLOC_ALLOW_THP", "0")

# A closed terminal ends Snakemake as SIGTERM does, without a lock left behind. A job started with nohup goes on.
if signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:
    signal.signal(signal.SIGHUP, lambda number, frame: signal.raise_signal(signal.SIGTERM))

# The default config files, for pages that show them.
CONFIG_FILES = [os.path.relpath(file) for file in DEFAULT_FILES]
# "" or "NAME/": a config with a prefix has its own folder of results and figures.
PREFIX = config["prefix"] and f"{config['prefix']}/"
CORES = workflow.cores or 1
# Threads of a job that computes in parallel. Snakemake reserves one core for it, so that two jobs run on two cores at a
# time: each has serial parts, and together they finish sooner than one after the other.
JOB_THREADS = min(THREADS, CORES)


wildcard_constraints:
    name="[A-Za-z][A-Za-z0-9_-]*",


# -- names of files ----------------------------------------------------------------------------------------------------


def source(path):
    """A file of this workflow, also when Snakemake runs in another folder."""
    return os.path.relpath(ROOT / path)


def sources(pattern):
    """The files of this workflow that match a pattern."""
    return sorted(source(path) for path in ROOT.glob(pattern))


def result(name):
    return f"results/{PREFIX}{name}"


def table(reference):
    """The file of the table SECTION/NAME; tables of the section `results` lie in the folder of results itself."""
    return result(f"{reference.removeprefix('results/')}.parquet")


def reference_of(file):
    """The table SECTION/NAME in a file."""
    name = file.rpartition(f"results/{PREFIX}")[2].removesuffix(".parquet")
    return name if os.path.dirname(name) else f"results/{name}"


def tables_of(*references):
    """Inputs or outputs: the files of tables, by the names of the tables."""
    return {reference.split("/")[1]: table(reference) for reference in references}


def page(name):
    """A page of the documentation: part of the repository if it is made from the paper's config."""
    return result(f"docs/{name}") if PREFIX else f"docs/{name}"


def top_level_page(name):
    """A page of the project's folder if it is made from the paper's config."""
    return result(f"docs/{name}") if PREFIX else name


def log_file(name):
    return result(f"logs/{name}.log")


def benchmark_file(name):
    return result(f"benchmarks/{name}.tsv")


def figure_file(figure, ending="pdf"):
    return f"figures/{PREFIX}{figure}.{ending}"


def figure_files(ending="pdf"):
    return [figure_file(figure, ending) for figure in config["figures"]]


def caption_files(figures=config["figures"]):
    return [result(f"captions/{figure}.rst") for figure in figures]


def one_of(names):
    """A wildcard constraint: one of these names."""
    return "|".join(map(re.escape, names)) or "(?!)"


# -- params ------------------------------------------------------------------------------------------------------------


def stage(module):
    """Common params of jobs with the script make.py: the module that it calls, the hash of all code behind it, and
    what each input table must be.
    """
    return {"stage": module, "code": source_hash("make", module.replace(".", os.sep)), "expected": expected}


def settings(section):
    """A param: the settings of the table SECTION/{name}."""
    return lambda wildcards: settings_of(config, f"{section}/{wildcards.name}")


def expected(wildcards, input):
    """A param: kind and settings that each input table must have, so that no other table is read in its place."""
    references = {file: reference_of(file) for file in input if file.endswith(".parquet")}
    return {file: [kind_of(name), settings_of(config, name)] for file, name in references.items()}


# -- sweeps ------------------------------------------------------------------------------------------------------------

PLANS = {name: plan(config["sharing"], resolve(config, "sweeps", name)) for name in config["sweeps"]}
MARGIN = 3  # a job may take so many times its estimated time
JOINED_ROWS = 20_000_000  # a minute


def shards_of_sweep(wildcards):
    """All shards, in the order of their rows."""
    return [table(f"shards/{wildcards.name}/{shard}") for shard in range(PLANS[wildcards.name].shards)]


def rows_of_shard(wildcards):
    """First row of a shard, and the row behind its last one."""
    sweep = PLANS[wildcards.name]
    first = int(wildcards.shard) * sweep.rows
    return [first, min(first + sweep.rows, sweep.points)]


# The fit of Eq. 13 as in the paper; None for a machine of the user's own whose config has no such entry.
PAPER_FIT = config["regressions"].get("height")


# -- figures -----------------------------------------------------------------------------------------------------------

FIGURES = config["figures"] | config["figures_on_request"]


def tables_of_figure(wildcards):
    """The files of the tables that a figure draws, by their roles."""
    return {role: table(reference) for role, reference in FIGURES[wildcards.figure]["tables"].items()}


def refuse_figure(wildcards):
    """An error for a figure that makes no sense for this machine, raised only when the figure is requested."""
    reason = REFUSED[wildcards.figure]
    raise WorkflowError(f"{figure_file(wildcards.figure)} is not made for this machine: {reason}")


def references_of_captions(figures):
    """The tables that the captions of figures read."""
    roles = [entry.get(key, {}) for entry in figures.values() for key in ("tables", "caption_tables")]
    return sorted({reference for of_figure in roles for reference in of_figure.values()})


# -- claims ------------------------------------------------------------------------------------------------------------


def references_of_claims(claims):
    """The tables that claims read."""
    return sorted({reference for claim in claims.values() for reference in claim["tables"].values()})


# Each claim alone.
CLAIM = {name: {name: claim} for name, claim in config["claims"].items()}
RESULT_TESTS = sources("tests/results/*.py")
CHECKS_RESULTS = bool(RESULT_TESTS) and not OWN_MACHINE
# The tables that the tests of the results read.
TESTED_TABLES = [
    table(reference)
    for reference in (
        *(f"orbits/{name}" for name in TABLES["orbits"]),
        *(f"lyapunov/{name}" for name in TABLES["lyapunov"]),
        *(f"precision/{name}" for name in config["precision"]["scenes"]),
        *(f"results/{name}" for name in TABLES["results"] if name not in ON_REQUEST),
    )
    if CHECKS_RESULTS
]


# -- builds ------------------------------------------------------------------------------------------------------------


def tables_read():
    """The tables that figures, captions and claims are made from."""
    return {
        table(name) for name in (*references_of_captions(config["figures"]), *references_of_claims(config["claims"]))
    }


# Files that no figure reads, and the tables that are made with them.
MADE_WITH = {
    table("identification/implied"): table("identification/profiles"),
    table("sensitivity/groups"): table("sensitivity/derivatives"),
    result("benchmark.md"): table("results/benchmark"),
}


def built_files():
    """All results and figures of the manifest."""
    figures = [*figure_files(), *figure_files("png"), *caption_files()]
    tables = {table("results/claims"), *tables_read(), *TESTED_TABLES}
    beside = [file for file, made_with in MADE_WITH.items() if made_with in tables]
    return sorted({*figures, result("claims.md"), *tables, *beside})


def holds_times(reference):
    return kind_of(reference) in TIMED


# Kinds of tables with measured times, which differ from build to build.
TIMED = ("benchmark", "precision_times", "certificate_times", "budget_times", "scaling")


def timed_files():
    """Files of the manifest that differ from build to build: tables with measured times, and what is made from them."""
    files = {file for file in built_files() if file.endswith(".parquet") and holds_times(reference_of(file))}
    files.add(result("benchmark.md"))
    for figure, entry in config["figures"].items():
        if any(map(holds_times, entry["tables"].values())):
            files |= {figure_file(figure), figure_file(figure, "png")}
    if any(map(holds_times, references_of_claims(config["claims"]))):
        files |= {table("results/claims"), result("claims.md")}
    return sorted(files & {*built_files()})


def archived_sources():
    """The sources that redraw the figures of an archive and remake its results, and the overlays."""
    top = ["Snakefile", "README.md", "LICENSE", "CITATION.cff", "CONTRIBUTING.md", "CHANGELOG.md", "pyproject.toml"]
    folders = ["config/**/*", "workflow/**/*", "profiles/**/*", "scripts/**/*", "tests/**/*"]
    files = [file for pattern in (*top, "environment.txt", "conveyor.def", *folders) for file in sources(pattern)]
    inside = [file for file in OVERLAYS if not file.startswith("..")]
    return [file for file in dict.fromkeys([*files, *inside]) if Path(file).is_file() and "__pycache__" not in file]


def package_names():
    """The packages that any script imports."""
    scripts = [path.relative_to(SCRIPTS).with_suffix("").as_posix() for path in SCRIPTS.rglob("*.py")]
    return closure(*scripts)[1]


def archived_results():
    last = [table("results/claims"), *map(result, ("claims.md", "manifest.sha256", "provenance.json"))]
    return [*figure_files(), *caption_files(), *sorted(tables_read()), *last]


def archived_figures():
    """What redraws each figure: its tables by their roles, their kinds, and its settings."""
    return {
        figure_file(name): {
            "name": name,
            "tables": {role: table(reference) for role, reference in entry["tables"].items()},
            "kinds": {role: kind_of(reference) for role, reference in entry["tables"].items()},
            "settings": entry.get("settings", {}),
        }
        for name, entry in config["figures"].items()
    }


# -- report ------------------------------------------------------------------------------------------------------------


def report_file(name):
    return result(f"report/{name}.html")


REPORT_PAGES = figure_pages(
    {
        name: {
            "name": name,
            **{key: entry[key] for key in ("title", "section")},
            "file": figure_file(name),
            "png": figure_file(name, "png"),
            "rst": result(f"captions/{name}.rst"),
        }
        for name, entry in config["figures"].items()
    }
)
REPORT_NOTICE = notice(OVERLAYS, config["sweeps"], PAPER["sweeps"])
REPORTS_FINDINGS = bool(config["claims"]) and config["claims"].keys() >= PAPER["claims"].keys()


# -- docs --------------------------------------------------------------------------------------------------------------

# The tables behind the numbers in texts, by their roles in scripts/docs/facts.py.
FACTS = {
    **tables_of("results/claims", "results/benchmark", "lyapunov/spectrum", "orbits/cascade"),
    **tables_of("orbits/certificates", "orbits/certified_bifurcations", "orbits/certified_chaos"),
    "edge": table("critical/edge"),
    "edge_euler": table("critical/edge_euler"),
    "estimate": table("estimates/phase"),
    "estimate_euler": table("estimates/phase_euler"),
    "fit": table("regressions/height"),
}
PAGE_PARAMS = {
    "figures": {name: {key: entry[key] for key in ("title", "section")} for name, entry in config["figures"].items()},
    "values": {
        "prefix": config["prefix"],
        "step": config["solver"]["step"],
        "tighter": config["uncertainty"]["tighter"],
    },
}
ARTICLE_PARTS = {
    "captions": caption_files(),
    "costs": result("costs.json"),
    "uncertainty": result("uncertainty.json"),
    "proved": page("certificates.md"),
}
LIBRARY = sorted(
    path.relative_to(SCRIPTS).with_suffix("").as_posix()
    for path in (SCRIPTS / "conveyor").rglob("*.py")
    if path.name != "__init__.py"
)


def files_of_costs():
    """The files that each figure and each claim is made from."""
    figures = {name: [figure_file(name)] for name in config["figures"]}
    claims = config["claims"].items()
    return figures | {name: [table(reference) for reference in one["tables"].values()] for name, one in claims}


def written_keys(wildcards):
    """A param: the keys of the paper's config, with the comments there."""
    return [key._asdict() for key in all_written(CONFIG_FILES)]


def known_keys(wildcards):
    """A param: all keys that a config may have."""
    return [key._asdict() for key in config_keys(json.loads(json_schema()))]
