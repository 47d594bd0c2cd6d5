# Sweeps: a product of axes, one trajectory per point, one table per entry of the config. They are simulated in shards, so
# that a cluster can share a large one, and labelled as a whole; the table does not depend on how it was cut.

POINTS_PER_JOB = config["solver"]["points_per_job"]


def rows_of_shard(wildcards):
    """First row of a shard and the row behind its last one."""
    begin = int(wildcards.shard) * POINTS_PER_JOB
    return [begin, min(begin + POINTS_PER_JOB, count_points(config["sweeps"][wildcards.name]["axes"]))]


def shards_of_sweep(wildcards):
    """The files of all shards, in the order of their rows."""
    shards = math.ceil(count_points(config["sweeps"][wildcards.name]["axes"]) / POINTS_PER_JOB)
    return [table("runs", f"{wildcards.name}/{shard}") for shard in range(shards)]


RULES["runs"] = {
    "stage": "sweeps.runs",
    "message": "Sweep {wildcards.name}, shard {wildcards.shard}",
    "output": {"runs": table("runs", "{name}/{shard}")},
    "place": "runs/{name}/{shard}",
    "names": {"name": one_of(config["sweeps"]), "shard": r"\d+"},
    "threads": 2,
    "params": {"settings": settings("sweeps"), "rows": rows_of_shard},
}

entry_rule(
    "sweeps",
    "sweeps.labels",
    "States of motion of sweep",
    input={"runs": shards_of_sweep},
    threads=2,
    mem_mb=2000,
    runtime=60,
)
