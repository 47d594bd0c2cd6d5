# The drive from the file of an accelerometer. Only a config with `excitation.measured` has these targets.
from conveyor_pipeline.machine.excitation.settings import EXCITATION_TABLES

EXCITATION_FILES = [result("excitation.md"), result("measured_drive.yaml"), figure_file("excitation")]
EXCITATION_FILES = EXCITATION_FILES if MEASURED["excitation"] else []


rule excitation:
    """Parameters and harmonics of the measured drive."""
    input:
        measured=measured_file("excitation"),
    output:
        **tables_of(*(f"excitation/{name}" for name in EXCITATION_TABLES)),
    log:
        log_file("excitation/parameters"),
    benchmark:
        benchmark_file("excitation/parameters")
    params:
        **stage("conveyor_pipeline.machine.excitation.measure", "excitation/parameters"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule excitation_comparison:
    """Transit on the measured drive, with and without its harmonics."""
    input:
        **tables_of("excitation/parameters", "excitation/harmonics"),
    output:
        **tables_of("excitation/comparison"),
    log:
        log_file("excitation/comparison"),
    benchmark:
        benchmark_file("excitation/comparison")
    threads: THREADS
    params:
        **stage("conveyor_pipeline.machine.excitation.comparison", "excitation/comparison"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule clean_drive:
    """Transit on drives with one harmonic."""
    output:
        **tables_of("excitation/clean_drive"),
    log:
        log_file("excitation/clean_drive"),
    benchmark:
        benchmark_file("excitation/clean_drive")
    params:
        **stage("conveyor_pipeline.machine.excitation.clean_drive", "excitation/clean_drive"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule excitation_page:
    """The measured drive in words."""
    input:
        **tables_of(*(f"excitation/{name}" for name in ("parameters", "harmonics", "quality", "comparison"))),
        template=source("workflow/rules/machine/excitation.md"),
    output:
        page=result("excitation.md"),
    log:
        log_file("excitation/page"),
    params:
        **stage("conveyor_pipeline.machine.excitation.page"),
        prefix=config["prefix"],
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule measured_drive:
    """An overlay with the measured drive."""
    input:
        **tables_of("excitation/parameters", "excitation/harmonics"),
    output:
        overlay=result("measured_drive.yaml"),
    log:
        log_file("excitation/measured_drive"),
    params:
        **stage("conveyor_pipeline.machine.excitation.overlay"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"
