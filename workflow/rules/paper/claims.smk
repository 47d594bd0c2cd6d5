# The paper's statements with their verdicts, and the tests of the results.
from conveyor_pipeline.config.tables import references, tighter_claims

# Each claim alone.
CLAIM = {name: {name: claim} for name, claim in config["claims"].items()}


def findings_of(claims):
    """The modules of their findings, as paths below scripts/ without ".py"."""
    names = sorted({claim["finding"].split(".")[0] for claim in claims.values()})
    return [module for name in names for module in figure_modules(name, "claims")]


CLAIM_FILES = [table("results/claims"), result("claims.md")] if IS_PAPER else []
TIGHTER_CLAIMS = tighter_claims(config)
# Tests of the results, which apply to the paper's conveyor only, and the tables that they read.
RESULT_TESTS = sources("tests/results/*.py") if IS_PAPER else []
CHECKED = [result("checked.txt")] if RESULT_TESTS else []
TESTED_TABLES = [
    reference
    for reference in references(config)
    if reference.startswith(("orbits/", "lyapunov/", "precision/", "results/")) and RESULT_TESTS
]


rule claims:
    """The paper's statements."""
    input:
        read=lambda wildcards: tables_of_claims(config["claims"]),
        template=source("workflow/templates/claims.md"),
    output:
        claims=table("results/claims"),
        report=report(result("claims.md"), category="Claims", labels={"figure": "the paper's statements"}),
    log:
        log_file("checks/claims"),
    benchmark:
        benchmark_file("checks/claims")
    params:
        **stage(
            "conveyor_pipeline.paper.claims.verdicts",
            "results/claims",
            scripts=lambda wildcards: findings_of(config["claims"]),
        ),
        references=references_of(config["claims"]),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule claim:
    """One of the statements."""
    input:
        read=lambda wildcards: tables_of_claims(CLAIM[wildcards.name]),
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
        **stage(
            "conveyor_pipeline.paper.claims.one_claim",
            scripts=lambda wildcards: findings_of(CLAIM[wildcards.name]),
        ),
        settings=lambda wildcards: {"claims": CLAIM[wildcards.name]},
        references=lambda wildcards: references_of(CLAIM[wildcards.name]),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule uncertainty:
    """Uncertainty of the claims' numbers."""
    input:
        read=lambda wildcards: tables_of_claims(TIGHTER_CLAIMS),
        claims=table("results/claims"),
    output:
        uncertainty=result("uncertainty.json"),
    log:
        log_file("checks/uncertainty"),
    benchmark:
        benchmark_file("checks/uncertainty")
    params:
        **stage(
            "conveyor_pipeline.paper.claims.uncertainty",
            scripts=lambda wildcards: findings_of(TIGHTER_CLAIMS),
        ),
        settings={"claims": TIGHTER_CLAIMS},
        references=references_of(TIGHTER_CLAIMS),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule check_results:
    """Tests of the results."""
    input:
        map(table, TESTED_TABLES),
        figure_files(),
        RESULT_TESTS,
    output:
        checked=result("checked.txt"),
    log:
        log_file("checks/results"),
    benchmark:
        benchmark_file("checks/results")
    threads: THREADS
    resources:
        mem_mb=1500,
    params:
        **stage("conveyor_pipeline.paper.claims.check_results"),
        results=lambda wildcards, output: os.path.dirname(output.checked),
        figures=config["figures"],
        tests=lambda wildcards: source("tests/results"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"
