# Manifest and provenance of a build, which are made after all other files.
import hashlib
import json

# The tables that figures, captions, claims and tests of the results read.
BUILT_TABLES = sorted(
    {"results/claims", *references_of(config["figures"]), *references_of(config["claims"]), *TESTED_TABLES}
)
BUILT_FILES = [
    *map(table, BUILT_TABLES),
    *([result("benchmark.md")] if RESULT_TESTS else []),
    result("claims.md"),
    *caption_files(),
    *figure_files(),
    *figure_files(ending="png"),
]
BUILD_RECORDS = [result("manifest.sha256"), result("provenance.json")]
# Kinds of tables with measured times, which differ from build to build, and the figures that are drawn from them.
TIMED = {"precision_times", "certificate_times", "budget_times"}
TIMED_FIGURES = [name for name, entry in config["figures"].items() if TIMED & {*map(kind_of, entry["tables"].values())}]


# The last job, which runs alone: it needs one core, but records how many there are.
rule provenance:
    input:
        BUILT_FILES,
        CHECKED,
    output:
        manifest=result("manifest.sha256"),
        provenance=result("provenance.json"),
    log:
        log_file("builds/provenance"),
    benchmark:
        benchmark_file("builds/provenance")
    threads: CORES
    params:
        **stage("conveyor_pipeline.common.provenance"),
        files=sorted(BUILT_FILES),
        timed=[
            *(table(name) for name in BUILT_TABLES if kind_of(name) in TIMED),
            result("benchmark.md"),
            *(figure_file(name, ending) for name in TIMED_FIGURES for ending in ("pdf", "png")),
        ],
        config=hashlib.sha256(json.dumps(config).encode()).hexdigest(),
        benchmarks=result("benchmarks"),
        logs=result("logs"),
    message:
        "The manifest of all results; commit, config, versions and processor of the build"
    script:
        "../../scripts/conveyor_pipeline/make.py"
