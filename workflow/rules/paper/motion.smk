# The motion of single parts: over time, as spectra, at their first impacts; heights at which the state of motion changes.


rule motion:
    """Motion of single parts: signals, spectra, impacts, critical heights."""
    output:
        table("{section}/{name}"),
    log:
        log_file("{section}/{name}"),
    benchmark:
        benchmark_file("{section}/{name}")
    wildcard_constraints:
        section="signals|spectra|impacts|critical",
        name=one_of({name for section in ("signals", "spectra", "impacts", "critical") for name in config[section]}),
    params:
        **stage("conveyor_pipeline.paper.motion.{section}", "{section}/{name}"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"
