# How bifurcations and critical heights move with each parameter, and the curves of folds and doublings in two parameters.


rule sensitivity:
    """Changes of bifurcations and critical heights with each parameter."""
    input:
        **tables_of("orbits/folds_and_doublings", "orbits/cascade"),
        critical=table(f"critical/{config['sensitivity']['critical']}"),
    output:
        table("sensitivity/changes"),
    log:
        log_file("sensitivity/changes"),
    benchmark:
        benchmark_file("sensitivity/changes")
    params:
        **stage("conveyor_pipeline.paper.sensitivity.changes", "sensitivity/changes"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule curves:
    """Folds and period doublings in two parameters."""
    input:
        **tables_of("orbits/folds_and_doublings", "orbits/cascade"),
    output:
        **tables_of("sensitivity/continued", "sensitivity/meetings"),
    log:
        log_file("sensitivity/curves"),
    benchmark:
        benchmark_file("sensitivity/curves")
    params:
        **stage("conveyor_pipeline.paper.sensitivity.curves", "sensitivity/continued"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule frictions:
    """Velocities over the friction."""
    output:
        **tables_of("sensitivity/frictions"),
    log:
        log_file("sensitivity/frictions"),
    benchmark:
        benchmark_file("sensitivity/frictions")
    params:
        **stage("conveyor_pipeline.paper.sensitivity.frictions", "sensitivity/frictions"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"
