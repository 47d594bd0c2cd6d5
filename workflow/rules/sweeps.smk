# Sweeps: a product of axes, one trajectory per point and the state that it leads to, one table per entry of the config. They
# are computed in shards, so that a cluster can share a large one; the table does not depend on how it was cut.
from workflow.config.sharing import plan

PLANS = {name: plan(config["sharing"], resolve(config, "sweeps", name)) for name in config["sweeps"]}
LATER = 3  # times what was expected, so long a job may run
ROWS_A_MINUTE = 20_000_000  # that are put together


def rows_of_shard(wildcards):
    """First row of a shard and the row behind its last one."""
    shared = PLANS[wildcards.name]
    begin = int(wildcards.shard) * shared.rows
    return [begin, min(begin + shared.rows, shared.points)]


def shards_of_sweep(wildcards):
    """The files of all shards, in the order of their rows."""
    return [table("shards", f"{wildcards.name}/{shard}") for shard in range(PLANS[wildcards.name].shards)]


def memory_of_shard(wildcards, attempt):
    """MB of a shard: more if it was not enough before."""
    return math.ceil(attempt * PLANS[wildcards.name].memory)


def minutes_of_shard(wildcards, attempt):
    return math.ceil(attempt * (10 + LATER * PLANS[wildcards.name].seconds / 60))


def memory_of_gathering(wildcards, attempt):
    return math.ceil(attempt * PLANS[wildcards.name].gathering)


def minutes_of_gathering(wildcards, attempt):
    return math.ceil(attempt * (10 + LATER * PLANS[wildcards.name].points / ROWS_A_MINUTE))


RULES["shards"] = {
    "stage": "sweeps.shards",
    "message": "Sweep {wildcards.name}, shard {wildcards.shard}",
    "output": {"sweeps": table("shards", "{name}/{shard}")},
    "place": "shards/{name}/{shard}",
    "names": {"name": one_of(config["sweeps"]), "shard": r"\d+"},
    "threads": THREADS,
    "mem_mb": memory_of_shard,
    "runtime": minutes_of_shard,
    "params": {"settings": settings("sweeps"), "rows": rows_of_shard},
}

RULES["sweeps"] = {
    "script": "gather",
    "output": {"sweeps": table("sweeps")},
    "params": {"settings": settings("sweeps"), "points": lambda wildcards: PLANS[wildcards.name].points},
}


rule sweeps:
    input:
        shards_of_sweep,
    output:
        **RULES["sweeps"]["output"],
    log:
        log_file("sweeps/{name}"),
    benchmark:
        benchmark_file("sweeps/{name}")
    wildcard_constraints:
        name=one_of(config["sweeps"]),
    threads: 1
    resources:
        mem_mb=memory_of_gathering,
        runtime=minutes_of_gathering,
    params:
        **RULES["sweeps"]["params"],
        code=source_hash("gather"),
    message:
        "Sweep {wildcards.name}, all shards"
    script:
        "../../scripts/gather.py"
