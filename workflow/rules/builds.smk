# Tests of the results, and manifest and provenance of a build, which are made after all other files.
import hashlib
import json

TESTED_TABLES = [name for name in references(config) if RESULT_TESTS and name.startswith(tuple(TESTED))]
CHECKED = [result("checked.txt")] if RESULT_TESTS else []
# The tables that figures, captions, claims and tests of the results read.
BUILT_TABLES = sorted({*references_of(config["figures"]), *references_of(CLAIMS), *TESTED_TABLES})
BUILT_FILES = sorted(
    {
        *map(table, BUILT_TABLES),
        *BUILT,
        *caption_files(),
        *figure_files(),
        *figure_files(ending="png"),
    }
)
BUILD_RECORDS = [result("manifest.sha256"), result("provenance.json")]
# Figures with measured times.
TIMED_FIGURES = [
    name for name, entry in config["figures"].items() if {*TIMED} & {*map(kind_of, entry["tables"].values())}
]


rule check_results:
    """Tests of the results."""
    input:
        map(table, TESTED_TABLES),
        figure_files(),
        RESULT_TESTS,
    output:
        checked=result("checked.txt"),
    log:
        log_file("checks/results"),
    benchmark:
        benchmark_file("checks/results")
    threads: THREADS
    resources:
        mem_mb=1500,
    params:
        **stage("conveyor_pipeline.common.check_results"),
        results=lambda wildcards, output: os.path.dirname(output.checked),
        figures=config["figures"],
        tests=lambda wildcards: source("tests/results"),
    script:
        "../../scripts/conveyor_pipeline/make.py"


# The last job, which runs alone: it needs one core, but records how many there are.
rule provenance:
    """The manifest of all results; commit, config, versions and processor of the build."""
    input:
        BUILT_FILES,
        CHECKED,
    output:
        manifest=result("manifest.sha256"),
        provenance=result("provenance.json"),
    log:
        log_file("builds/provenance"),
    threads: CORES
    params:
        **stage("conveyor_pipeline.common.provenance"),
        files=BUILT_FILES,
        timed=[
            *(table(name) for name in BUILT_TABLES if kind_of(name) in TIMED),
            *TIMED_PAGES,
            *(figure_file(name, ending) for name in TIMED_FIGURES for ending in ("pdf", "png")),
            *caption_files(TIMED_FIGURES),
        ],
        config=hashlib.sha256(json.dumps(config).encode()).hexdigest(),
        benchmarks=result("benchmarks"),
        logs=result("logs"),
    script:
        "../../scripts/conveyor_pipeline/make.py"
