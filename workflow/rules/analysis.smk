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


rule regressions:
    input:
        critical=lambda wildcards: table("critical", config["regressions"][wildcards.name]["critical"]),
    output:
        table("regressions"),
    log:
        log_file("regressions"),
    benchmark:
        benchmark_file("regressions")
    wildcard_constraints:
        name=one_of(config["regressions"]),
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        settings=lambda wildcards: config["regressions"][wildcards.name],
        code=source_hash("regressions"),
    message:
        "Fit of Eq. 13, {wildcards.name}"
    script:
        "../../scripts/regressions.py"


rule dimensions:
    output:
        table("dimensions"),
    log:
        log_file("dimensions"),
    benchmark:
        benchmark_file("dimensions")
    wildcard_constraints:
        name=one_of(config["dimensions"]),
    threads: 2
    resources:
        mem_mb=2000,
        runtime=30,
    params:
        settings=settings("dimensions"),
        code=source_hash("dimensions"),
    message:
        "Fractal dimensions, {wildcards.name}"
    script:
        "../../scripts/dimensions.py"


rule signals:
    output:
        table("signals"),
    log:
        log_file("signals"),
    benchmark:
        benchmark_file("signals")
    wildcard_constraints:
        name=one_of(config["signals"]),
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        settings=settings("signals"),
        code=source_hash("signals"),
    message:
        "Signals over time, {wildcards.name}"
    script:
        "../../scripts/signals.py"


rule spectra:
    output:
        table("spectra"),
    log:
        log_file("spectra"),
    benchmark:
        benchmark_file("spectra")
    wildcard_constraints:
        name=one_of(config["spectra"]),
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        settings=settings("spectra"),
        code=source_hash("spectra"),
    message:
        "Spectra of the velocities, {wildcards.name}"
    script:
        "../../scripts/spectra.py"


rule impacts:
    output:
        table("impacts"),
    log:
        log_file("impacts"),
    benchmark:
        benchmark_file("impacts")
    wildcard_constraints:
        name=one_of(config["impacts"]),
    threads: 2
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        settings=settings("impacts"),
        code=source_hash("impacts"),
    message:
        "First impacts, {wildcards.name}"
    script:
        "../../scripts/impacts.py"
