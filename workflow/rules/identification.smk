# Which parameters the paper's numbers imply: edges of the first state over the parameters of the contact, and the posterior. These
# jobs start first, because they wait for each other.


rule identification_edges:
    output:
        **tables_of("identification/edges"),
    log:
        log_file("identification/edges"),
    benchmark:
        benchmark_file("identification/edges")
    priority: 3
    threads: THREADS
    params:
        **stage("identification.edges", "identification/edges"),
    message:
        "Edges of the first state over the contact parameters"
    script:
        "../../scripts/make.py"


rule identification_posterior:
    input:
        **tables_of("identification/edges"),
    output:
        **tables_of(
            "identification/numbers",
            "identification/fits",
            "identification/intervals",
            "identification/samples",
            "identification/frictions",
        ),
    log:
        log_file("identification/posterior"),
    benchmark:
        benchmark_file("identification/posterior")
    priority: 3
    params:
        **stage("identification.posterior", "identification/numbers"),
    message:
        "Parameters that the paper's numbers imply"
    script:
        "../../scripts/make.py"
