# The paper's statements with their verdicts.
from conveyor_pipeline.config.tables import tighter_claims
from conveyor_pipeline.paper.claims.statements import read_claims

CLAIMS = read_claims()
CLAIM_FILES = [table("results/claims"), result("claims.md")] if IS_PAPER else []
TIGHTER_CLAIMS = tighter_claims(config, CLAIMS)


rule claims:
    """The paper's statements."""
    input:
        read=lambda wildcards: tables_of_claims(CLAIMS),
        template=source("workflow/rules/paper/claims.md"),
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
            scripts=lambda wildcards: findings_of(CLAIMS),
        ),
        references=references_of(CLAIMS),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule claim:
    """One of the statements."""
    input:
        read=lambda wildcards: tables_of_claims(claim_alone(wildcards)),
        template=source("workflow/rules/paper/claims.md"),
    output:
        report=result("claims/{name}.md"),
    log:
        log_file("checks/claims/{name}"),
    wildcard_constraints:
        name=one_of(CLAIMS),
    params:
        **stage(
            "conveyor_pipeline.paper.claims.one_claim",
            scripts=lambda wildcards: findings_of(claim_alone(wildcards)),
        ),
        settings=lambda wildcards: {"claims": claim_alone(wildcards)},
        references=lambda wildcards: references_of(claim_alone(wildcards)),
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
    params:
        **stage(
            "conveyor_pipeline.paper.claims.uncertainty",
            scripts=lambda wildcards: findings_of(TIGHTER_CLAIMS),
        ),
        settings={"claims": TIGHTER_CLAIMS},
        references=references_of(TIGHTER_CLAIMS),
    script:
        "../../../scripts/conveyor_pipeline/make.py"
