# Sweeps: a product of axes, one trajectory per point, one table per entry of the config. Large ones are cut into
# shards, so that a cluster can share them and an interrupted run loses little; the table does not depend on it.

POINTS_PER_JOB = config["solver"]["points_per_job"]
SWEEP_SIZES = {name: count_points(entry["axes"]) for name, entry in config["sweeps"].items()}


def shards_of_sweep(wildcards):
    """The files of all shards, in the order of their rows."""
    shards = math.ceil(SWEEP_SIZES[wildcards.name] / POINTS_PER_JOB)
    return [f"results/{PREFIX}sweeps/{wildcards.name}.shards/{shard}.parquet" for shard in range(shards)]


def rows_of_shard(wildcards):
    """First row and row behind the last one."""
    begin = int(wildcards.shard) * POINTS_PER_JOB
    return [begin, min(begin + POINTS_PER_JOB, SWEEP_SIZES[wildcards.name])]


rule sweep:
    output:
        table("sweeps"),
    log:
        log_file("sweeps"),
    benchmark:
        benchmark_file("sweeps")
    wildcard_constraints:
        name=one_of(name for name, size in SWEEP_SIZES.items() if size <= POINTS_PER_JOB),
    threads: 2
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        settings=settings("sweeps"),
        code=source_hash("sweep"),
    message:
        "Sweep {wildcards.name}"
    script:
        "../../scripts/sweep.py"


rule sweep_shard:
    output:
        temp(f"results/{PREFIX}sweeps/{{name}}.shards/{{shard}}.parquet"),
    log:
        log_file("sweeps", "{name}.{shard}"),
    benchmark:
        benchmark_file("sweeps", "{name}.{shard}")
    wildcard_constraints:
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


rule join_sweep:
    input:
        shards_of_sweep,
    output:
        table("sweeps"),
    log:
        log_file("sweeps"),
    benchmark:
        benchmark_file("sweeps")
    wildcard_constraints:
        name=one_of(name for name, size in SWEEP_SIZES.items() if size > POINTS_PER_JOB),
    threads: 1
    resources:
        mem_mb=2000,
        runtime=10,
    params:
        settings=settings("sweeps"),
        code=source_hash("join_sweep", "sweep"),
    message:
        "Sweep {wildcards.name}: join its shards"
    script:
        "../../scripts/join_sweep.py"
