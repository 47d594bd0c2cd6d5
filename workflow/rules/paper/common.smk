# Functions that the rules of the paper share.
from conveyor_pipeline.common.axes import count_points
from conveyor_pipeline.config.entries import count_shards

SHARDS = {name: count_shards(config, entry) for name, entry in config["sweeps"].items()}


def shards_of_sweep(wildcards):
    """All shards, in the order of their rows."""
    return [table(f"shards/{wildcards.name}/{shard}") for shard in range(SHARDS[wildcards.name])]


def rows_of_shard(name, shard):
    """First row of a shard of a sweep, and the row after its last one."""
    first = shard * config["sharing"]["rows"]
    return [first, min(first + config["sharing"]["rows"], count_points(config["sweeps"][name]["axes"]))]


def rows_of_shards(wildcards):
    """The rows of all shards, in their order."""
    return [rows_of_shard(wildcards.name, shard) for shard in range(SHARDS[wildcards.name])]


def settings_of_shard(wildcards):
    """The settings of the table, and the rows of the shard; an error for a shard that the sweep does not have."""
    count = SHARDS[wildcards.name]
    if int(wildcards.shard) >= count:
        raise WorkflowError(
            f"sweeps.{wildcards.name} has no shard {wildcards.shard}: with this config, it has {count} from 0 on"
        )
    rows = rows_of_shard(wildcards.name, int(wildcards.shard))
    return settings_of_table(f"sweeps/{wildcards.name}") | {"rows": rows}


def tables_of_claims(claims):
    """The tables that claims read; an error for another conveyor than the paper's."""
    check_paper("the test of the paper's claims")
    return [table(reference) for reference in references_of(claims)]


def claim_alone(wildcards):
    """One claim by its name."""
    return {wildcards.name: CLAIMS[wildcards.name]}


def findings_of(claims):
    """The modules that compute the findings of claims, as paths below scripts/ without ".py"."""
    names = sorted({claim["finding"].split(".")[0] for claim in claims.values()})
    return [module for name in names for module in figure_modules(name, "claims")]
