# The paper's statements with their verdicts, and the tests of the results.


rule claims:
    input:
        read=[table(reference) for reference in references_of_claims(config["claims"])],
        template=source("workflow/templates/claims.md"),
    output:
        claims=table("results/claims"),
        report=result("claims.md"),
    log:
        log_file("checks/claims"),
    benchmark:
        benchmark_file("checks/claims")
    params:
        **stage("claims.verdicts"),
        settings=settings_of(config, "results/claims"),
        references=references_of_claims(config["claims"]),
    message:
        "The paper's statements"
    script:
        "../../scripts/make.py"


rule claim:
    input:
        read=lambda wildcards: [table(name) for name in references_of_claims(CLAIM[wildcards.name])],
        template=source("workflow/templates/claims.md"),
    output:
        report=result("claims/{name}.md"),
    log:
        log_file("checks/claims/{name}"),
    benchmark:
        benchmark_file("checks/claims/{name}")
    wildcard_constraints:
        name=one_of(config["claims"]),
    params:
        **stage("claims.one_claim"),
        settings=lambda wildcards: {"claims": CLAIM[wildcards.name]},
        references=lambda wildcards: references_of_claims(CLAIM[wildcards.name]),
    message:
        "The statement {wildcards.name} alone"
    script:
        "../../scripts/make.py"


rule uncertainty:
    input:
        read=[table(reference) for reference in references_of_claims(tighter_claims(config))],
        claims=table("results/claims"),
    output:
        uncertainty=result("uncertainty.json"),
    log:
        log_file("checks/uncertainty"),
    benchmark:
        benchmark_file("checks/uncertainty")
    params:
        **stage("claims.uncertainty"),
        settings={"claims": tighter_claims(config)},
        references=references_of_claims(tighter_claims(config)),
    message:
        "Uncertainty of the claims' numbers"
    script:
        "../../scripts/make.py"


rule check_results:
    input:
        TESTED_TABLES,
        figure_files(),
        RESULT_TESTS,
    output:
        checked=result("checked.txt"),
    log:
        log_file("checks/results"),
    benchmark:
        benchmark_file("checks/results")
    params:
        **stage("claims.check_results"),
        results=lambda wildcards, output: os.path.dirname(output.checked),
        figures=config["figures"],
        tests=lambda wildcards: source("tests/results"),
    message:
        "Tests of the results"
    script:
        "../../scripts/make.py"
