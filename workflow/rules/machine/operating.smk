# Where to run a conveyor: the attractors that initial conditions in a box reach, the transit of parts along a track, and what
# follows for the operator.

from conveyor_pipeline.config.derived import origins_of
from conveyor_pipeline.machine.operating.settings import (
    START_TABLES,
    assumed_model,
    assumed_parts,
    remedies_for_amplitudes,
    uses_recording,
)

# If the config says so, the parameters of parts are drawn from the samples of the calibration, around their best values. The overlay
# exists only if the model explains the measurements.
IS_CALIBRATED = config["parts"].get("calibrated")
CALIBRATED_PARTS = tables_of("calibration/samples", "calibration/parameters") if IS_CALIBRATED else {}
CALIBRATED_OVERLAY = [result("calibrated.yaml")] if IS_CALIBRATED else []
# Of the target `machine`, for any conveyor.
OPERATING_FIGURES = listed_figures("operating", "basin_stability", "transit", "track")
OPERATING_FILES = [result("operating/chart.md"), *figure_files(OPERATING_FIGURES), *caption_files(OPERATING_FIGURES)]
CHART_TABLES = [f"operating/{name}" for name in ("transit", "shares", "regimes", "advice", "changes")]
BUILT += [*map(table, CHART_TABLES), result("operating/chart.md")]


rule operating:
    """Share of initial conditions that reach each attractor, and regimes over the amplitude."""
    output:
        **tables_of("operating/shares", "operating/regimes"),
    log:
        log_file("operating/shares"),
    benchmark:
        benchmark_file("operating/shares")
    threads: THREADS
    params:
        **stage("conveyor_pipeline.machine.operating.shares", "operating/shares"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule transit:
    """Transit of parts along a track, over the amplitude."""
    input:
        CALIBRATED_OVERLAY,
        **CALIBRATED_PARTS,
    output:
        **tables_of("operating/transit"),
    log:
        log_file("operating/transit"),
    benchmark:
        benchmark_file("operating/transit")
    threads: THREADS
    params:
        **stage("conveyor_pipeline.machine.operating.transit", "operating/transit"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule bodies:
    """Velocities of blocks of several shapes beside those of points."""
    output:
        **tables_of("operating/bodies", "operating/body_shapes", "operating/landing"),
    log:
        log_file("operating/bodies"),
    benchmark:
        benchmark_file("operating/bodies")
    params:
        **stage("conveyor_pipeline.machine.operating.bodies", "operating/bodies"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule drift:
    """Drift and diffusion in chaos, and the spread of transit over the length of the track."""
    input:
        **tables_of("operating/regimes"),
    output:
        **tables_of("operating/drift", "operating/track_lengths"),
    log:
        log_file("operating/drift"),
    benchmark:
        benchmark_file("operating/drift")
    threads: THREADS
    params:
        **stage("conveyor_pipeline.machine.operating.drift", "operating/drift"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule advice:
    """Where to run the conveyor, and what helps there."""
    input:
        CALIBRATED_OVERLAY,
        **CALIBRATED_PARTS,
        **tables_of("operating/transit", "operating/shares"),
    output:
        **tables_of("operating/advice", "operating/changes"),
    log:
        log_file("operating/advice"),
    benchmark:
        benchmark_file("operating/advice")
    threads: THREADS
    params:
        **stage("conveyor_pipeline.machine.operating.advice", "operating/advice"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule start:
    """Switching the drive on and off."""
    input:
        CALIBRATED_OVERLAY,
        **CALIBRATED_PARTS,
        **tables_of("operating/advice"),
    output:
        **tables_of(*(f"operating/{name}" for name in START_TABLES)),
    log:
        log_file("operating/start"),
    benchmark:
        benchmark_file("operating/start")
    threads: THREADS
    params:
        **stage("conveyor_pipeline.machine.operating.start", "operating/start"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule throws:
    """Motions of several conveyors over the throw number."""
    output:
        **tables_of("operating/throws"),
    log:
        log_file("operating/throws"),
    benchmark:
        benchmark_file("operating/throws")
    threads: THREADS
    params:
        **stage("conveyor_pipeline.machine.operating.throws", "operating/throws"),
        models=models_of_examples,
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule track:
    """Velocities over inclination and phase shift."""
    output:
        **tables_of("operating/track"),
    log:
        log_file("operating/track"),
    benchmark:
        benchmark_file("operating/track")
    threads: THREADS
    params:
        **stage("conveyor_pipeline.machine.operating.track", "operating/track"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule operating_chart:
    """The operating chart in words."""
    input:
        **tables_of(*CHART_TABLES),
        template=source("workflow/rules/machine/operating_chart.md"),
    output:
        chart=result("operating/chart.md"),
    log:
        log_file("operating/chart"),
    benchmark:
        benchmark_file("operating/chart")
    params:
        **stage("conveyor_pipeline.machine.operating.chart"),
        assumed=assumed_parts(config, loaded.stated),
        assumed_model=assumed_model(loaded.stated, origins_of(config)) if PREFIX else [],
        measured_drive="" if uses_recording(config, loaded.stated) else result("measured_drive.yaml"),
        remedies=remedies_for_amplitudes(config, loaded.stated),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule drive:
    """Search for the settings of the drive."""
    output:
        **tables_of("operating/drive_front", "operating/drive_generations"),
    log:
        log_file("operating/drive_front"),
    benchmark:
        benchmark_file("operating/drive_front")
    threads: THREADS
    params:
        **stage("conveyor_pipeline.machine.operating.drive", "operating/drive_front"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


# The tables from which the pages on request are made.
ON_REQUEST = {
    "start": tables_of("operating/advice", *(f"operating/{name}" for name in START_TABLES)),
    "drive": tables_of("operating/drive_front", "operating/drive_generations"),
}


rule operating_page:
    """Switching the drive, or its recommended settings, in words."""
    input:
        unpack(lambda wildcards: ON_REQUEST[wildcards.page]),
        template=source("workflow/rules/machine/{page}.md"),
    output:
        result("{page}.md"),
    log:
        log_file("operating/{page}_page"),
    wildcard_constraints:
        page=one_of(ON_REQUEST),
    params:
        **stage("conveyor_pipeline.machine.operating.{page}_page"),
        has_body="body" in config,
    script:
        "../../../scripts/conveyor_pipeline/make.py"
