# Manifest, provenance and archive of a build, which are made after all other files.
import hashlib
import json

from scripts.conveyor import __version__

# The tables that figures, captions and claims are made from, and tables that the same jobs make for pages only.
QUOTED_TABLES = sorted({*references_of(config["figures"]), *references_of(config["claims"])})
BYPRODUCTS = {
    "sensitivity/derivatives": "sensitivity/groups",
}
BUILT_TABLES = sorted(
    {
        "results/claims",
        *QUOTED_TABLES,
        *TESTED_TABLES,
        *(BYPRODUCTS[name] for name in QUOTED_TABLES if name in BYPRODUCTS),
    }
)
BUILT_FILES = [
    *map(table, BUILT_TABLES),
    *([result("benchmark.md")] if "results/benchmark" in BUILT_TABLES else []),
    result("claims.md"),
    *caption_files(),
    *figure_files(),
    *figure_files("png"),
]
BUILD_RECORDS = [result("manifest.sha256"), result("provenance.json")]
# Kinds of tables with measured times, which differ from build to build, and the figures that are drawn from them.
TIMED = {"benchmark", "precision_times", "certificate_times", "budget_times"}
TIMED_FIGURES = [name for name, entry in config["figures"].items() if TIMED & {*map(kind_of, entry["tables"].values())}]
# Sources in an archive, with which its figures and results can be made again.
ARCHIVED = [
    *("Snakefile", "README.md", "LICENSE", "CITATION.cff", "CONTRIBUTING.md", "CHANGELOG.md", "pyproject.toml"),
    *("environment.txt", "conveyor.def", "config/**/*", "workflow/**/*", "profiles/**/*", "scripts/**/*", "tests/**/*"),
]


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
        **stage("builds.provenance"),
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
        "../../scripts/make.py"


rule archive:
    input:
        results=[
            *figure_files(),
            *caption_files(),
            *map(table, QUOTED_TABLES),
            *CLAIM_FILES,
            *BUILD_RECORDS,
        ],
        sources=[file for pattern in ARCHIVED for file in sources(pattern)],
        overlays=[file for file in OVERLAYS if not file.startswith("..")],
        readme=source("workflow/templates/ARCHIVE.md"),
    output:
        directory(f"archive/{config['prefix'] or 'paper'}"),
    log:
        log_file("builds/archive"),
    benchmark:
        benchmark_file("builds/archive")
    params:
        figures={
            figure_file(name): {
                "name": name,
                "tables": {role: table(reference) for role, reference in entry["tables"].items()},
                "kinds": {role: kind_of(reference) for role, reference in entry["tables"].items()},
                "settings": entry.get("settings", {}),
            }
            for name, entry in config["figures"].items()
        },
        megabytes=config["archive"]["megabytes"],
        version=__version__,
        code=lambda wildcards: source_hash("archive"),
    message:
        "An archive of the figures, their tables and the sources"
    script:
        "../../scripts/archive.py"
