# The paper's statements with their verdicts.
from conveyor_pipeline.config.tables import tighter_claims

# Each claim alone.
CLAIM = {name: {name: claim} for name, claim in config["claims"].items()}
CLAIM_FILES = [table("results/claims"), result("claims.md")] if IS_PAPER else []
TIGHTER_CLAIMS = tighter_claims(config)


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
