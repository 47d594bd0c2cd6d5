# How accurate, how fast, how robust: the solver against other methods. Rules that take wall times get the machine to
# themselves; such a time changes whenever it is taken, so that nothing which must have equal bytes is made from it.


def benchmark_cases():
    """The cases of the benchmark with all defaults, by name."""
    cases = config["benchmark"]["cases"]
    solver = {key: config["solver"][key] for key in ("duration", "step")}
    return {name: {**solver, **case, "model": {**config["model"], **case["model"]}} for name, case in cases.items()}


rule benchmark:
    output:
        table=result("benchmark.parquet"),
        report=result("benchmark.md"),
    log:
        log_file("accuracy", "benchmark"),
    benchmark:
        benchmark_file("accuracy", "benchmark")
    threads: WHOLE_MACHINE
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        cases=benchmark_cases(),
        tolerance=config["solver"]["tolerance"],
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


def scene(wildcards):
    """A param: one scene of the section `precision` with its model."""
    precision = config["precision"]
    model = {**config["model"], **precision["scenes"][wildcards.name]}
    shared = {name: precision[name] for name in ("duration", "tolerances", "steps", "peers", "max_evaluations")}
    return {**shared, "model": model}


rule precision:
    output:
        table("precision"),
    log:
        log_file("precision"),
    benchmark:
        benchmark_file("precision")
    wildcard_constraints:
        name=one_of(config["precision"]["scenes"]),
    threads: 1
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        settings=scene,
        code=source_hash("precision"),
    message:
        "Error against work, {wildcards.name}"
    script:
        "../../scripts/precision.py"


rule wall_times:
    input:
        table("precision"),
    output:
        table("wall_times"),
    log:
        log_file("wall_times"),
    benchmark:
        benchmark_file("wall_times")
    wildcard_constraints:
        name=one_of(config["precision"]["scenes"]),
    threads: WHOLE_MACHINE
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        settings={name: config["precision"][name] for name in ("repeats", "seconds")},
        code=source_hash("wall_times"),
    message:
        "Wall times, {wildcards.name}"
    script:
        "../../scripts/wall_times.py"


rule estimators:
    input:
        table("critical", config["regressions"]["height"]["critical"]) if "height" in config["regressions"] else [],
    output:
        result("estimators.parquet"),
    log:
        log_file("accuracy", "estimators"),
    benchmark:
        benchmark_file("accuracy", "estimators")
    threads: 1
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        settings=config["estimators"],
        model=config["model"],
        fit=config["regressions"].get("height"),
        code=source_hash("estimators"),
    message:
        "Error against work of the estimators"
    script:
        "../../scripts/estimators.py"


rule stability:
    output:
        result("stability.parquet"),
    log:
        log_file("accuracy", "stability"),
    benchmark:
        benchmark_file("accuracy", "stability")
    threads: 1
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        settings=config["stability"],
        code=source_hash("stability"),
    message:
        "Where methods stop working"
    script:
        "../../scripts/stability.py"


rule stability_estimates:
    output:
        result("stability_estimates.parquet"),
    log:
        log_file("accuracy", "stability_estimates"),
    benchmark:
        benchmark_file("accuracy", "stability_estimates")
    threads: 1
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        settings=config["stability_estimates"],
        model=config["model"],
        code=source_hash("stability_estimates"),
    message:
        "How far the paper's estimates carry"
    script:
        "../../scripts/stability_estimates.py"


rule settling_times:
    output:
        result("settling_times.parquet"),
    log:
        log_file("accuracy", "settling_times"),
    benchmark:
        benchmark_file("accuracy", "settling_times")
    threads: 2
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        settings={**config["settling_times"], "settling": config["solver"]["settling"]},
        model=config["model"],
        tolerance=config["solver"]["tolerance"],
        code=source_hash("settling_times"),
    message:
        "After how many cycles starts have settled"
    script:
        "../../scripts/settling_times.py"


def entry_settings(reference):
    """All that a converged table depends on, with an axis over the amplitude where its section has no axes."""
    section, name = reference.split("/")
    if section in ("attractors", "lyapunov"):
        merged = of_sections("attractors") if section == "attractors" else of_sections("attractors", "lyapunov")
        return {**merged, "axes": {"acceleration": merged["acceleration"]}, "duration": None}
    return resolve(config, section, name)


def drawn_tables():
    """The converged tables of trajectories that each figure draws, by its name."""
    sections = config["scene_budget"]["points"]
    return {
        figure: [
            reference
            for reference in dict.fromkeys(entry["tables"].values())
            if reference.split("/")[0] in sections and reference != "lyapunov/witnesses"
            if "method" not in (entry_of(config, reference) or {})
        ]
        for figure, entry in config["figures"].items()
    }


rule scene_budget:
    output:
        table=result("scene_budget.parquet"),
        times=result("budget_times.parquet"),
    log:
        log_file("accuracy", "scene_budget"),
    benchmark:
        benchmark_file("accuracy", "scene_budget")
    threads: WHOLE_MACHINE
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        entries={name: entry_settings(name) for names in drawn_tables().values() for name in names},
        drawn=drawn_tables(),
        budget=config["scene_budget"],
        code=source_hash("scene_budget"),
    message:
        "What the data of each figure need"
    script:
        "../../scripts/scene_budget.py"


rule rigid_part:
    input:
        sweep=table("sweeps", "amplitudes"),
        bifurcations=table("orbits", "folds_and_doublings"),
        cascade=table("orbits", "cascade"),
    output:
        result("rigid_part.parquet"),
    log:
        log_file("accuracy", "rigid_part"),
    benchmark:
        benchmark_file("accuracy", "rigid_part")
    threads: 1
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        sweep=resolve(config, "sweeps", "amplitudes"),
        settings=config["rigid_part"],
        code=source_hash("rigid_part"),
    message:
        "A rigid part in place of the contact"
    script:
        "../../scripts/rigid_part.py"
