# How accurate, fast and robust the solver is, compared with other methods. Measured times are processor times, so that these jobs
# can run beside others.
from conveyor_pipeline.study.accuracy import scenes
from conveyor_pipeline.study.accuracy.budgeted import budgeted_entries, budgeted_tables

PRECISION |= {
    f"{scene}{ending}": table(f"precision{ending}/{scene}") for scene in scenes.SCENES for ending in ("", "_times")
}


# These jobs start early, because each scene keeps one core busy for a long time.
rule precision:
    """Error and work of all methods."""
    output:
        precision=table("precision/{name}"),
        precision_times=table("precision_times/{name}"),
    log:
        log_file("precision/{name}"),
    benchmark:
        benchmark_file("precision/{name}")
    wildcard_constraints:
        name=one_of(scenes.SCENES),
    priority: 2
    params:
        **stage("conveyor_pipeline.study.accuracy.precision", "precision/{name}"),
        repeats=config["precision"]["repeats"],
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule benchmark:
    """The solver compared with the paper's method."""
    input:
        **PRECISION,
        template=source("workflow/rules/study/benchmark.md"),
    output:
        result("benchmark.md"),
    log:
        log_file("accuracy/benchmark"),
    benchmark:
        benchmark_file("accuracy/benchmark")
    params:
        **stage("conveyor_pipeline.study.accuracy.benchmark_page"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


# The tables that each table of the rule `accuracy` is made from; most are made from the config alone.
COMPARED_TABLES = {
    **dict.fromkeys(("stability", "settling_times"), {}),
    "map_check": {"maps": [table(f"sweeps/{name}") for name in config["map_check"]["maps"]]},
    "theory": tables_of("orbits/cascade"),
}


rule accuracy:
    """Limits, times and errors of methods."""
    input:
        unpack(lambda wildcards: COMPARED_TABLES[wildcards.name]),
    output:
        table("results/{name}"),
    log:
        log_file("accuracy/{name}"),
    benchmark:
        benchmark_file("accuracy/{name}")
    wildcard_constraints:
        name=one_of(COMPARED_TABLES),
    threads: THREADS
    params:
        **stage("conveyor_pipeline.study.accuracy.{name}", "results/{name}"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule scene_budget:
    """Accuracy that the data of each figure need."""
    output:
        scene_budget=table("results/scene_budget"),
        budget_times=table("results/budget_times"),
    log:
        log_file("accuracy/scene_budget"),
    benchmark:
        benchmark_file("accuracy/scene_budget")
    priority: 1
    threads: THREADS
    params:
        **stage("conveyor_pipeline.study.accuracy.scene_budget", "results/scene_budget"),
        entries=budgeted_entries(config),
        drawn=budgeted_tables(config),
    script:
        "../../../scripts/conveyor_pipeline/make.py"
