# Periodic orbits, attractors over the amplitude, their Lyapunov exponents, and proofs.


rule estimates:
    """Lyapunov exponents by finite differences."""
    output:
        estimates=table("estimates/{name}"),
    log:
        log_file("estimates/{name}"),
    benchmark:
        benchmark_file("estimates/{name}")
    wildcard_constraints:
        name=one_of(config["estimates"]),
    params:
        **stage("conveyor_pipeline.paper.orbits.estimates", "estimates/{name}"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule orbits:
    """Periodic orbits."""
    output:
        **tables_of("orbits/branches", "orbits/folds_and_doublings", "orbits/cascade"),
    log:
        log_file("orbits/orbits"),
    benchmark:
        benchmark_file("orbits/orbits")
    params:
        **stage("conveyor_pipeline.paper.orbits.branches", "orbits/branches"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule certificates:
    """Proofs of orbits, bifurcations and chaos."""
    input:
        **tables_of("orbits/branches", "orbits/folds_and_doublings", "orbits/cascade"),
    output:
        **tables_of("orbits/certificates", "orbits/certified_bifurcations", "orbits/certified_chaos"),
        # Measured times have their own table, so that the other tables have equal bytes in every build.
        certificate_times=table("orbits/certificate_times"),
    log:
        log_file("orbits/certificates"),
    benchmark:
        benchmark_file("orbits/certificates")
    threads: THREADS
    params:
        **stage("conveyor_pipeline.paper.orbits.certified", "orbits/certificates"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule attractors:
    """Attractors over the amplitude."""
    output:
        **tables_of("attractors/strobes"),
    log:
        log_file("attractors/strobes"),
    benchmark:
        benchmark_file("attractors/strobes")
    threads: THREADS
    params:
        **stage("conveyor_pipeline.paper.orbits.strobes", "attractors/strobes"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule lyapunov:
    """Lyapunov exponents over the amplitude."""
    input:
        **tables_of("attractors/strobes"),
    output:
        **tables_of("lyapunov/spectrum"),
    log:
        log_file("lyapunov/spectrum"),
    benchmark:
        benchmark_file("lyapunov/spectrum")
    threads: THREADS
    params:
        **stage("conveyor_pipeline.paper.orbits.exponents", "lyapunov/spectrum"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule estimators:
    """How far estimates of exponents and dimensions can be trusted."""
    output:
        table("results/{name}"),
    log:
        log_file("estimators/{name}"),
    benchmark:
        benchmark_file("estimators/{name}")
    wildcard_constraints:
        name="stability_estimates|moved_impacts",
    params:
        **stage("conveyor_pipeline.paper.orbits.{name}", "results/{name}"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"
