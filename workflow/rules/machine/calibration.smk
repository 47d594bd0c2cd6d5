# Parameters of a conveyor from measured velocities. Only a config with `calibration.measurements` has these targets.
CALIBRATION_FILES = [result("calibration.md"), figure_file("calibration")] if MEASURED["calibration"] else []


rule calibration:
    """Parameters that the measured velocities imply."""
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
        **stage("conveyor_pipeline.machine.calibration.calibrate", "calibration/parameters"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule calibration_prediction:
    """Velocities that the calibrated model predicts, and the next measurement."""
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
        **stage("conveyor_pipeline.machine.calibration.prediction", "calibration/prediction"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule calibration_page:
    """The calibration in words."""
    input:
        **tables_of(*(f"calibration/{name}" for name in ("parameters", "fit", "alternatives", "prediction", "next"))),
        measurements=measured_file("calibration"),
        template=source("workflow/rules/machine/calibration.md"),
    output:
        page=result("calibration.md"),
    log:
        log_file("calibration/page"),
    params:
        **stage("conveyor_pipeline.machine.calibration.page"),
        prefix=config["prefix"],
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule calibrated:
    """An overlay with the calibrated parameters."""
    input:
        **tables_of("calibration/parameters", "calibration/fit"),
    output:
        overlay=result("calibrated.yaml"),
    log:
        log_file("calibration/calibrated"),
    params:
        **stage("conveyor_pipeline.machine.calibration.overlay"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"
