# Eq. 13 fitted to critical initial heights.


rule regressions:
    """Fit of Eq. 13."""
    input:
        critical=lambda wildcards: table(f"critical/{config['regressions'][wildcards.name]['critical']}"),
    output:
        regressions=table("regressions/{name}"),
    log:
        log_file("regressions/{name}"),
    benchmark:
        benchmark_file("regressions/{name}")
    wildcard_constraints:
        name=one_of(config["regressions"]),
    params:
        **stage("conveyor_pipeline.paper.fit.regressions", "regressions/{name}"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"
