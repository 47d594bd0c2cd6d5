# What all rules share: where files are, what an entry of the config depends on, what a script runs.
import json
import math
from pathlib import Path

from workflow.configuration import TABLES, count_points, entry_of, resolve
from workflow.source_hash import source_hash

# "" or "NAME/": a config with a prefix keeps its results apart.
PREFIX = config["prefix"] and f"{config['prefix']}/"

# Jobs that take wall times run alone. Snakemake does not say how many cores a node of a cluster has: there a profile does.
WHOLE_MACHINE = workflow.cores or 1


wildcard_constraints:
    name="[A-Za-z][A-Za-z0-9_-]*",


def table(section, name="{name}"):
    """The Parquet table of an entry of the config; those of the section `results` lie in the folder itself."""
    if section == "results":
        return result(f"{name}.parquet")
    return f"results/{PREFIX}{section}/{name}.parquet"


def result(name):
    """A result that is not an entry of a section of the config."""
    return f"results/{PREFIX}{name}"


def log_file(section, name="{name}"):
    return f"results/{PREFIX}logs/{section}/{name}.log"


def benchmark_file(section, name="{name}"):
    return f"results/{PREFIX}benchmarks/{section}/{name}.tsv"


def one_of(names):
    """A wildcard constraint: one of these names, none other."""
    return "|".join(map(re.escape, names)) or "(?!)"


def settings(section):
    """A param: all that the entry {name} of `section` depends on (see workflow/configuration.py)."""

    def settings_of(wildcards):
        return resolve(config, section, wildcards.name)

    return settings_of
