# What is made from the motion of single trajectories or from sweeps: exponents, orbits, spectra, dimensions.


rule estimate:
    output:
        table("estimates"),
    log:
        log_file("estimates"),
    benchmark:
        benchmark_file("estimates")
    wildcard_constraints:
        name=one_of(config["estimates"]),
    threads: 2
    resources:
        mem_mb=2000,
        runtime=30,
    params:
        settings=settings("estimates"),
        code=source_hash("estimate"),
    message:
        "Lyapunov exponents by finite differences, {wildcards.name}"
    script:
        "../../scripts/estimate.py"


rule critical:
    output:
        table("critical"),
    log:
        log_file("critical"),
    benchmark:
        benchmark_file("critical")
    wildcard_constraints:
        name=one_of(config["critical"]),
    threads: 2
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        settings=settings("critical"),
        code=source_hash("critical"),
    message:
        "Critical initial heights, {wildcards.name}"
    script:
        "../../scripts/critical.py"
