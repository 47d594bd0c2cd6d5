# Fractal dimensions of phase portraits.


rule dimensions:
    """Fractal dimensions of phase portraits."""
    output:
        dimensions=table("dimensions/{name}"),
    log:
        log_file("dimensions/{name}"),
    benchmark:
        benchmark_file("dimensions/{name}")
    wildcard_constraints:
        name=one_of(config["dimensions"]),
    threads: THREADS
    params:
        **stage("conveyor_pipeline.paper.dimensions.portraits", "dimensions/{name}"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"
