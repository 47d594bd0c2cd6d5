# Which parameters the paper's numbers imply: the quantities of the claims over the parameters, and the best fits. These jobs start
# first, because they wait for each other. A job of the rule `precision` starts beside them, because both share little compiled code.


rule identification_edges:
    output:
        **tables_of("identification/edges"),
    log:
        log_file("identification/edges"),
    benchmark:
        benchmark_file("identification/edges")
    priority: 3
    resources:
        cpus_per_task=JOB_THREADS,
    params:
        **stage("identification.edges", "identification/edges"),
    message:
        "Edges of the first state over the contact parameters"
    script:
        "../../scripts/make.py"


rule identification_printed:
    input:
        **tables_of("identification/edges"),
    output:
        **tables_of("identification/printed"),
    log:
        log_file("identification/printed"),
    benchmark:
        benchmark_file("identification/printed")
    priority: 3
    params:
        **stage("identification.printed", "identification/printed"),
    message:
        "The paper's numbers at the paper's parameters"
    script:
        "../../scripts/make.py"


rule identification_fronts:
    input:
        **tables_of("identification/edges"),
    output:
        **tables_of("identification/front", "identification/generations"),
    log:
        log_file("identification/fronts"),
    benchmark:
        benchmark_file("identification/fronts")
    priority: 3
    params:
        **stage("identification.fronts", "identification/front"),
    message:
        "Best fits to the paper's numbers"
    script:
        "../../scripts/make.py"


rule identification_profiles:
    input:
        **tables_of("identification/edges", "identification/front", "identification/printed"),
    output:
        **tables_of(
            "identification/profiles", "identification/optima", "identification/frictions", "identification/implied"
        ),
    log:
        log_file("identification/profiles"),
    benchmark:
        benchmark_file("identification/profiles")
    priority: 3
    params:
        **stage("identification.profiles", "identification/profiles"),
    message:
        "Confidence interval of each parameter"
    script:
        "../../scripts/make.py"
