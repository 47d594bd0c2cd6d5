# Sweeps: a product of axes, one trajectory per point and the state that it leads to, one table per entry of the config. They
# are computed in shards, so that a cluster can share a large one; the table does not depend on how it was cut.
MOST_SHARDS = 500  # of one sweep: each is a job, which takes seconds to start


def points_of(name):
    return count_points(config["sweeps"][name]["axes"])


def rows_per_shard(name):
    return max(config["solver"]["points_per_job"], math.ceil(points_of(name) / MOST_SHARDS))


def rows_of_shard(wildcards):
    """First row of a shard and the row behind its last one."""
    rows = rows_per_shard(wildcards.name)
    begin = int(wildcards.shard) * rows
    return [begin, min(begin + rows, points_of(wildcards.name))]


def shards_of_sweep(wildcards):
    """The files of all shards, in the order of their rows."""
    shards = math.ceil(points_of(wildcards.name) / rows_per_shard(wildcards.name))
    return [table("shards", f"{wildcards.name}/{shard}") for shard in range(shards)]


RULES["shards"] = {
    "stage": "sweeps.shards",
    "message": "Sweep {wildcards.name}, shard {wildcards.shard}",
    "output": {"sweeps": table("shards", "{name}/{shard}")},
    "place": "shards/{name}/{shard}",
    "names": {"name": one_of(config["sweeps"]), "shard": r"\d+"},
    "threads": 2,
    "runtime": 60,
    "params": {"settings": settings("sweeps"), "rows": rows_of_shard},
}

RULES["sweeps"] = {
    "script": "gather",
    "output": {"sweeps": table("sweeps")},
    "params": {"settings": settings("sweeps")},
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
        mem_mb=1000,
        runtime=30,
    params:
        **RULES["sweeps"]["params"],
        code=source_hash("gather"),
    message:
        "Sweep {wildcards.name}, all shards"
    script:
        "../../scripts/gather.py"
