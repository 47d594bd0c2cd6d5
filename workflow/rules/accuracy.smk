# How accurate, how fast, how robust: the solver against other methods. Rules that take wall times get the machine to
# themselves; such a time changes whenever it is taken, so that nothing which must have equal bytes is made from it.


def benchmark_cases():
    """The cases of the benchmark with all defaults, by name."""
    cases = config["benchmark"]["cases"]
    solver = {key: config["solver"][key] for key in ("duration", "tolerance", "step")}
    return {name: {**solver, **case, "model": {**config["model"], **case["model"]}} for name, case in cases.items()}


rule benchmark:
    output:
        table=result("benchmark.parquet"),
        report=result("benchmark.md"),
    log:
        log_file("accuracy", "benchmark"),
    benchmark:
        benchmark_file("accuracy", "benchmark")
    threads: workflow.cores
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        cases=benchmark_cases(),
        repeats=config["benchmark"]["repeats"],
        code=source_hash("benchmark"),
    message:
        "The solver against the paper's method"
    script:
        "../../scripts/benchmark.py"


rule random_points:
    output:
        result("random_points.parquet"),
    log:
        log_file("accuracy", "random_points"),
    benchmark:
        benchmark_file("accuracy", "random_points")
    threads: 2
    resources:
        mem_mb=2000,
        runtime=30,
    params:
        settings=config["random_points"],
        code=source_hash("random_points"),
    message:
        "Random conveyors and starts"
    script:
        "../../scripts/random_points.py"
