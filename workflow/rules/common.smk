# What all rules share: where files are, what an entry of the config depends on, and the loop that makes the rules.
#
# The stages' files fill RULES: one entry for each rule that makes tables or pages, with what it needs to know. All of them
# run scripts/make.py on a module of their stage.
import glob
import hashlib
import json
import math
import os
import re
from pathlib import Path
from types import SimpleNamespace

from scripts.docs.config_keys import all_written
from scripts.docs.config_keys import keys as config_keys
from workflow.config.schema import json_schema
from workflow.config.sharing import THREADS
from workflow.config.tables import (
    ON_REQUEST,
    TABLES,
    count_points,
    count_values,
    entry_of,
    kind_of,
    resolve,
    roles_of_solution,
    tighter_reference,
)
from workflow.source_hash import SCRIPTS, closure, source_hash, versions

# The memory of tables comes without huge pages: on a machine where these are slow to clear, the first small table of a job
# waited for that longer than all its writing took. Nor does what puts shards together take as much of it then.
os.environ.setdefault("MIMALLOC_ALLOW_THP", "0")

# "" or "NAME/": a config with a prefix keeps its results apart.
PREFIX = config["prefix"] and f"{config['prefix']}/"

# Jobs that take wall times run alone, on a cluster with a node to themselves. Snakemake does not say how many cores a node
# has: there a profile does.
WHOLE_MACHINE = workflow.cores or 1
ALONE = {"cores": WHOLE_MACHINE, "resources": {"slurm_extra": "--exclusive"}}

# The model for sections that name their amplitudes themselves: the default one must not make them run again.
MODEL_OF_ANY_AMPLITUDE = {name: value for name, value in config["model"].items() if name != "acceleration"}

# Rules by their names, each with
#   stage     the module of scripts/ that does the work
#   script    of one that has a rule of its own, and no stage: its script
#   message   what it makes, in words
#   output    one file, or files by their names
# and, where they differ from those in make.smk, the others; and
#   priority  of long jobs, or a chain of them, that each keep one processor busy: before others, which then run beside them
#             (2: first of all; what begins together where nothing is compiled yet should share little compiled code)
#   cores     of the machine that a job keeps from others
#   threads   that it computes on, if those are more: two jobs beside each other use two cores better than one after the
#             other, as each has parts that keep one of them busy only; a job that is alone has both. Snakemake gives
#             linear algebra as many threads as a job keeps cores, and last digits depend on that: one, on any machine.
#   timed     names of the outputs that hold measured times, which may differ from run to run
RULES = {}


wildcard_constraints:
    name="[A-Za-z][A-Za-z0-9_-]*",


def table(section, name="{name}"):
    """The Parquet table of an entry of the config; those of the section `results` lie in the folder itself."""
    if section == "results":
        return result(f"{name}.parquet")
    return f"results/{PREFIX}{section}/{name}.parquet"


def tables_of(section, *names):
    """Tables of a section by their names, as outputs or inputs of a rule."""
    return {name: table(section, name) for name in names}


def result(name):
    """A result that is not an entry of a section of the config."""
    return f"results/{PREFIX}{name}"


def page(name):
    """A page of the documentation: kept beside the sources if it is made from the paper's config."""
    return result(f"docs/{name}") if PREFIX else f"docs/{name}"


def log_file(place):
    return f"results/{PREFIX}logs/{place}.log"


def benchmark_file(place):
    return f"results/{PREFIX}benchmarks/{place}.tsv"


def one_of(names):
    """A wildcard constraint: one of these names, none other."""
    return "|".join(map(re.escape, names)) or "(?!)"


def settings(section):
    """A param: all that the entry {name} of `section` depends on (see workflow/configuration.py)."""

    def settings_of(wildcards):
        return resolve(config, section, wildcards.name)

    return settings_of


def sources_of(one):
    """What an entry of RULES runs, as source_hash names it."""
    return [one.get("script", "make"), *([one["stage"].replace(".", "/")] if "stage" in one else [])]


def pattern_of(file):
    """The files that a rule's output stands for, as a regular expression with a group for each wildcard."""
    return re.sub(r"\\{(\w+)\\}", r"(?P<\1>\\w[\\w-]*)", re.escape(file))


def settings_of_table(file):
    """The settings that the table in `file` is made from, or None if its rule has none."""
    for one in RULES.values():
        for output in one.get("output", {}).values():
            if found := re.fullmatch(pattern_of(output), file):
                wanted = one.get("params", {}).get("settings")
                return wanted(SimpleNamespace(**found.groupdict())) if callable(wanted) else wanted
    return None


def asked(wildcards, input):
    """A param: the settings that each table among the inputs must have been made from, by its file."""
    return {file: settings_of_table(file) for file in input if file.endswith(".parquet")}


def read_tables(references):
    """Input and params of a rule that reads tables by their references, SECTION/NAME."""
    references = sorted(set(references))
    return {
        "input": {"read": [table(*reference.split("/")) for reference in references]},
        "params": {"references": references, "kinds": {"read": [kind_of(reference) for reference in references]}},
    }


def entry_rule(section, stage, message, **rest):
    """The rule of a section of the config with a table for each of its entries."""
    RULES[section] = {
        "stage": stage,
        "message": f"{message}, {{wildcards.name}}",
        "output": {section: table(section)},
        "place": f"{section}/{{name}}",
        "names": {"name": one_of(config[section])},
        "params": {"settings": settings(section)},
        **rest,
    }
