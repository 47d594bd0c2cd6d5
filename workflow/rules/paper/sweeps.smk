# Sweeps: one trajectory for each point of a product of axes, and the state of motion that it leads to. Several jobs share a sweep
# of more rows than `sharing.rows`; the joined table does not depend on the number of shards.


rule sweeps:
    """The rows of a sweep."""
    output:
        sweeps=table("sweeps/{name}"),
    log:
        log_file("sweeps/{name}"),
    benchmark:
        benchmark_file("sweeps/{name}")
    wildcard_constraints:
        name=one_of(name for name, count in SHARDS.items() if count == 1),
    # The code of a small sweep is compiled on one core, so that other jobs run beside it.
    threads: lambda wildcards: THREADS if rows_of_shard(wildcards.name, 0)[1] > 10_000 else 1
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 120 * attempt,
    params:
        **stage("conveyor_pipeline.paper.sweeps.shards", "sweeps/{name}"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule shards:
    """Some rows of a sweep of several jobs."""
    output:
        sweeps=table("shards/{name}/{shard}"),
    log:
        log_file("shards/{name}/{shard}"),
    benchmark:
        benchmark_file("shards/{name}/{shard}")
    wildcard_constraints:
        name=one_of(config["sweeps"]),
        shard=r"0|[1-9]\d*",
    threads: THREADS
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 120 * attempt,
    params:
        **stage("conveyor_pipeline.paper.sweeps.shards"),
        settings=settings_of_shard,
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule joined_sweeps:
    """A sweep: its shards in the order of the rows."""
    input:
        shards_of_sweep,
    output:
        sweeps=table("sweeps/{name}"),
    log:
        log_file("sweeps/{name}"),
    benchmark:
        benchmark_file("sweeps/{name}")
    wildcard_constraints:
        name=one_of(name for name, count in SHARDS.items() if count > 1),
    params:
        settings=lambda wildcards: settings_of_table(f"sweeps/{wildcards.name}"),
        rows=rows_of_shards,
        code=lambda wildcards: code_of("conveyor_pipeline/gather"),
    script:
        "../../../scripts/conveyor_pipeline/gather.py"
