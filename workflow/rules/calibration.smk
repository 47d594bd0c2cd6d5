# Parameters of a conveyor from measured velocities, and of the paper's conveyor from its numbers. Only a config with
# `calibration.measurements` has targets of measured velocities. The simulation study of the method, docs/calibration_study.md, and the
# measurements of the example are made on request.
from scripts.calibration.effort import study_sets
from scripts.calibration.settings import POSTERIOR_TABLES

CALIBRATION_FILES = [result("calibration.md"), figure_file("calibration")] if MEASURED["calibration"] else []
# The data sets of the simulation study, numbered through.
STUDY_KINDS = study_sets(config["calibration"]["effort"])
STUDY_SETS = [result(f"calibration_study/{kind}_{number}.json") for number, kind in enumerate(STUDY_KINDS)]


rule calibration:
    input:
        measurements=measured_file("calibration"),
    output:
        **tables_of("calibration/parameters", "calibration/samples", "calibration/fit", "calibration/alternatives"),
    log:
        log_file("calibration/parameters"),
    benchmark:
        benchmark_file("calibration/parameters")
    threads: THREADS
    params:
        **stage("calibration.calibrate", "calibration/parameters"),
    message:
        "Parameters that the measured velocities imply"
    script:
        "../../scripts/make.py"


rule calibration_prediction:
    input:
        **tables_of("calibration/samples", "calibration/fit"),
    output:
        **tables_of("calibration/prediction", "calibration/next"),
    log:
        log_file("calibration/prediction"),
    benchmark:
        benchmark_file("calibration/prediction")
    threads: THREADS
    params:
        **stage("calibration.prediction", "calibration/prediction"),
    message:
        "Velocities that the calibrated model predicts, and the next measurement"
    script:
        "../../scripts/make.py"


rule calibration_page:
    input:
        **tables_of(*(f"calibration/{name}" for name in ("parameters", "fit", "alternatives", "prediction", "next"))),
        measurements=measured_file("calibration"),
        template=source("workflow/templates/calibration.md"),
    output:
        page=result("calibration.md"),
    log:
        log_file("calibration/page"),
    benchmark:
        benchmark_file("calibration/page")
    params:
        **stage("calibration.page"),
        prefix=config["prefix"],
    message:
        "The calibration in words"
    script:
        "../../scripts/make.py"


rule calibrated:
    input:
        **tables_of("calibration/parameters", "calibration/fit"),
    output:
        overlay=result("calibrated.yaml"),
    log:
        log_file("calibration/calibrated"),
    benchmark:
        benchmark_file("calibration/calibrated")
    params:
        **stage("calibration.overlay"),
    message:
        "An overlay with the calibrated parameters"
    script:
        "../../scripts/make.py"


rule study_set:
    output:
        row=result("calibration_study/{kind}_{number}.json"),
    log:
        log_file("calibration_study/{kind}_{number}"),
    benchmark:
        benchmark_file("calibration_study/{kind}_{number}")
    wildcard_constraints:
        kind=one_of(STUDY_KINDS),
        number=r"\d+",
    params:
        **stage("calibration.study"),
        settings=lambda wildcards: settings_of(config, "results/calibration_study"),
        kind=lambda wildcards: wildcards.kind,
        number=lambda wildcards: int(wildcards.number),
    message:
        "Study of the calibration: {wildcards.kind} {wildcards.number}"
    script:
        "../../scripts/make.py"


rule calibration_study:
    input:
        rows=STUDY_SETS,
    output:
        **tables_of("results/calibration_study"),
    log:
        log_file("calibration_study"),
    benchmark:
        benchmark_file("calibration_study")
    params:
        **stage("calibration.study_table", "results/calibration_study"),
    message:
        "Simulation study of the calibration"
    script:
        "../../scripts/make.py"


# The paper's numbers as data. These jobs start first, because they wait for each other. Their priority is above that of two jobs of
# `precision` together, which would begin beside each other on a cold cache and compile the same functions.
rule identification_edges:
    output:
        **tables_of("identification/edges"),
    log:
        log_file("identification/edges"),
    benchmark:
        benchmark_file("identification/edges")
    priority: 5
    threads: THREADS
    params:
        **stage("calibration.edges", "identification/edges"),
    message:
        "Edges of the first state over the contact parameters"
    script:
        "../../scripts/make.py"


rule identification_posterior:
    input:
        **tables_of("identification/edges"),
    output:
        **tables_of(*(f"identification/{name}" for name in POSTERIOR_TABLES)),
    log:
        log_file("identification/posterior"),
    benchmark:
        benchmark_file("identification/posterior")
    priority: 5
    params:
        **stage("calibration.paper_posterior", "identification/numbers"),
    message:
        "Parameters that the paper's numbers imply"
    script:
        "../../scripts/make.py"


# Not for a config with measurements, which reads this file at its start.
if not MEASURED["calibration"]:

    rule measured_example:
        output:
            measurements="config/examples/measured.csv",
        log:
            log_file("calibration/measured_example"),
        benchmark:
            benchmark_file("calibration/measured_example")
        params:
            **stage("calibration.synthetic"),
            settings={name: PAPER["operating"][name] for name in ("height", "vz0", "psi0")},
        message:
            "Synthetic measurements for the example"
        script:
            "../../scripts/make.py"
