# Sweeps: one trajectory for each point of a product of axes, and the state of motion that it leads to. A sweep is computed in
# shards, so that a cluster can share it; the joined table does not depend on the number of shards.
import math

MARGIN = 3  # runtime limit of a job, in units of its estimated time
JOINED_ROWS = 20_000_000  # rows joined per minute


rule shards:
    output:
        sweeps=table("shards/{name}/{shard}"),
    log:
        log_file("shards/{name}/{shard}"),
    benchmark:
        benchmark_file("shards/{name}/{shard}")
    wildcard_constraints:
        name=one_of(config["sweeps"]),
        shard=r"\d+",
    threads: THREADS
    resources:
        mem_mb=lambda wildcards, attempt: math.ceil(attempt * PLANS[wildcards.name].memory),
        runtime=lambda wildcards, attempt: math.ceil(attempt * (10 + MARGIN * PLANS[wildcards.name].seconds / 60)),
    params:
        **stage("sweeps.shards", "sweeps/{name}"),
        rows=rows_of_shard,
    message:
        "Sweep {wildcards.name}, shard {wildcards.shard}"
    script:
        "../../scripts/make.py"


rule sweeps:
    input:
        shards_of_sweep,
    output:
        sweeps=table("sweeps/{name}"),
    log:
        log_file("sweeps/{name}"),
    benchmark:
        benchmark_file("sweeps/{name}")
    wildcard_constraints:
        name=one_of(config["sweeps"]),
    resources:
        mem_mb=lambda wildcards, attempt: math.ceil(attempt * PLANS[wildcards.name].gathering),
        runtime=lambda wildcards, attempt: attempt * (10 + MARGIN * PLANS[wildcards.name].points // JOINED_ROWS),
    params:
        settings=lambda wildcards: settings_of(config, f"sweeps/{wildcards.name}"),
        points=lambda wildcards: PLANS[wildcards.name].points,
        code=lambda wildcards: source_hash("gather"),
    message:
        "Sweep {wildcards.name}, all shards"
    script:
        "../../scripts/gather.py"
