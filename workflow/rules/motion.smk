# The motion of single parts: over time, as spectra, at their first impacts; heights at which the state of motion changes.


rule signals:
    output:
        signals=table("signals/{name}"),
    log:
        log_file("signals/{name}"),
    benchmark:
        benchmark_file("signals/{name}")
    wildcard_constraints:
        name=one_of(config["signals"]),
    params:
        **stage("motion.signals"),
        settings=settings("signals"),
    message:
        "Signals over time, {wildcards.name}"
    script:
        "../../scripts/make.py"


rule spectra:
    output:
        spectra=table("spectra/{name}"),
    log:
        log_file("spectra/{name}"),
    benchmark:
        benchmark_file("spectra/{name}")
    wildcard_constraints:
        name=one_of(config["spectra"]),
    params:
        **stage("motion.spectra"),
        settings=settings("spectra"),
    message:
        "Spectra of the velocities, {wildcards.name}"
    script:
        "../../scripts/make.py"


rule impacts:
    output:
        impacts=table("impacts/{name}"),
    log:
        log_file("impacts/{name}"),
    benchmark:
        benchmark_file("impacts/{name}")
    wildcard_constraints:
        name=one_of(config["impacts"]),
    resources:
        cpus_per_task=JOB_THREADS,
    params:
        **stage("motion.impacts"),
        settings=settings("impacts"),
    message:
        "First impacts, {wildcards.name}"
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
        **stage("motion.critical_heights"),
        settings=settings("critical"),
    message:
        "Critical initial heights, {wildcards.name}"
    script:
        "../../scripts/make.py"
