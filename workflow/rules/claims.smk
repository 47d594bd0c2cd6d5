# The paper's statements with their verdicts, and the tests of the results.


def claim_references():
    """The tables that the claims need, as SECTION/NAME, sorted."""
    return sorted({reference for claim in config["claims"].values() for reference in claim["tables"].values()})


rule claims:
    input:
        [table(*reference.split("/")) for reference in claim_references()],
    output:
        table=result("claims.parquet"),
        report=report(result("claims.md"), caption="../report/claims.rst", category="Claims"),
    log:
        log_file("checks", "claims"),
    benchmark:
        benchmark_file("checks", "claims")
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        claims=config["claims"],
        references=claim_references(),
        code=source_hash("claims"),
    message:
        "The paper's statements"
    script:
        "../../scripts/claims.py"


rule check_results:
    input:
        claims=result("claims.parquet"),
        random_points=result("random_points.parquet"),
        orbits=[table("orbits", name) for name in TABLES["orbits"]],
        exponents=[table("lyapunov", name) for name in ("spectrum", "witnesses")],
        accuracy=[
            *(table("precision", scene) for scene in config["precision"]["scenes"]),
            result("stability.parquet"),
            result("stability_estimates.parquet"),
            result("scene_budget.parquet"),
            result("rigid_part.parquet"),
        ],
        figures=figure_files(),
        tests=sorted(Path(workflow.basedir).glob("tests/results/*.py")),
    output:
        result("checked.txt"),
    log:
        log_file("checks", "results"),
    benchmark:
        benchmark_file("checks", "results")
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        results=f"results/{PREFIX}",
        figures=config["figures"],
        code=source_hash("check_results"),
    message:
        "Tests of the results"
    script:
        "../../scripts/check_results.py"
