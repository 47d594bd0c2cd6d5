# The motion of single parts: over time, as spectra, at their first impacts; heights at which the state of motion changes.


rule motion:
    output:
        table("{section}/{name}"),
    log:
        log_file("{section}/{name}"),
    benchmark:
        benchmark_file("{section}/{name}")
    wildcard_constraints:
        section="signals|spectra|impacts",
        name=one_of({*config["signals"], *config["spectra"], *config["impacts"]}),
    resources:
        cpus_per_task=JOB_THREADS,
    params:
        **stage("motion.{section}", "{section}/{name}"),
    message:
        "Motion of single parts: {wildcards.section}, {wildcards.name}"
    script:
        "../../scripts/make.py"


rule critical:
    output:
        critical=table("critical/{name}"),
    log:
        log_file("critical/{name}"),
    benchmark:
        benchmark_file("critical/{name}")
    wildcard_constraints:
        name=one_of(config["critical"]),
    resources:
        cpus_per_task=JOB_THREADS,
    params:
        **stage("motion.critical_heights", "critical/{name}"),
    message:
        "Critical initial heights, {wildcards.name}"
    script:
        "../../scripts/make.py"
