# Sweeps: a product of axes, one trajectory per point, one table per entry of the config. They are simulated in shards, so
# that a cluster can share a large one, and classified as a whole; the table does not depend on how it was cut.

POINTS_PER_JOB = config["solver"]["points_per_job"]


def rows_of_shard(wildcards):
    """First row of a shard and the row behind its last one."""
    begin = int(wildcards.shard) * POINTS_PER_JOB
    return [begin, min(begin + POINTS_PER_JOB, count_points(config["sweeps"][wildcards.name]["axes"]))]


def shards_of_sweep(wildcards):
    """The files of all shards, in the order of their rows."""
    shards = math.ceil(count_points(config["sweeps"][wildcards.name]["axes"]) / POINTS_PER_JOB)
    return [table("runs", f"{wildcards.name}/{shard}") for shard in range(shards)]


rule sweep:
    output:
        table("runs", "{name}/{shard}"),
    log:
        log_file("runs", "{name}/{shard}"),
    benchmark:
        benchmark_file("runs", "{name}/{shard}")
    wildcard_constraints:
        name=one_of(config["sweeps"]),
        shard=r"\d+",
    threads: 2
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        settings=settings("sweeps"),
        rows=rows_of_shard,
        code=source_hash("sweep"),
    message:
        "Sweep {wildcards.name}, shard {wildcards.shard}"
    script:
        "../../scripts/sweep.py"


rule classify:
    input:
        shards_of_sweep,
    output:
        table("sweeps"),
    log:
        log_file("sweeps"),
    benchmark:
        benchmark_file("sweeps")
    wildcard_constraints:
        name=one_of(config["sweeps"]),
    threads: 2
    resources:
        mem_mb=2000,
        runtime=60,
    params:
        settings=settings("sweeps"),
        code=source_hash("classify"),
    message:
        "States of motion of sweep {wildcards.name}"
    script:
        "../../scripts/classify.py"
