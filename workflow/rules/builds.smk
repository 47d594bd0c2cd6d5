# What a build holds, and where it comes from: the last files of all.
import hashlib
import json
from pathlib import Path

# Kinds of tables with measured times, which differ from build to build.
TIMED = ("benchmark", "precision_times", "certificate_times", "budget_times")
# The tables that figures, captions and claims are made from.
READ = sorted({*references_of_captions(config["figures"]), *references_of_claims(config["claims"])})
# Tables that only pages read, and the tables that the same jobs make.
BESIDE = {"sensitivity/groups": "sensitivity/derivatives", "identification/implied": "identification/profiles"}


def built_files():
    """The files of the manifest."""
    tables = ["results/claims", *READ, *(name for name, made_with in BESIDE.items() if made_with in READ)]
    files = [*map(table, tables), result("claims.md"), *figure_files(), *figure_files("png"), *caption_files()]
    if CHECKED:
        files += [*map(table, TESTED_TABLES), result("benchmark.md")]
    return sorted({*files})


def timed_files():
    """The files of the manifest with measured times: tables, and what is made from them."""
    files = [file for file in built_files() if file.endswith(".parquet") and kind_of(reference_of(file)) in TIMED]
    for figure, entry in config["figures"].items():
        if any(kind_of(reference) in TIMED for reference in entry["tables"].values()):
            files += [figure_file(figure), figure_file(figure, "png")]
    return [*files, result("benchmark.md")]


def archived_sources():
    """The sources that draw the figures of an archive again and make its results again, and the overlays."""
    files = ["README.md", "LICENSE", "CITATION.cff", "CONTRIBUTING.md", "CHANGELOG.md", "pyproject.toml"]
    files += ["Snakefile", "environment.txt", "conveyor.def"]
    folders = [f"{folder}/**/*" for folder in ("config", "workflow", "profiles", "scripts", "tests")]
    overlays = [file for file in OVERLAYS if not file.startswith("..")]
    found = [*map(source, files), *(file for pattern in folders for file in sources(pattern)), *overlays]
    return [file for file in dict.fromkeys(found) if Path(file).is_file() and "__pycache__" not in file]


def archived_figures():
    """What draws each figure of an archive again: the plot, its tables by their roles, their kinds, and its settings."""
    return {
        figure_file(name): {
            "name": name,
            "tables": {role: table(reference) for role, reference in entry["tables"].items()},
            "kinds": {role: kind_of(reference) for role, reference in entry["tables"].items()},
            "settings": entry.get("settings", {}),
        }
        for name, entry in config["figures"].items()
    }


rule manifest:
    input:
        built_files(),
    output:
        manifest=result("manifest.sha256"),
    log:
        log_file("builds/manifest"),
    benchmark:
        benchmark_file("builds/manifest")
    params:
        **stage("builds.manifest"),
        files=built_files(),
        timed=timed_files(),
    message:
        "The manifest of all results and figures"
    script:
        "../../scripts/make.py"


rule provenance:
    input:
        result("manifest.sha256"),
        CHECKED,
    output:
        provenance=result("provenance.json"),
    log:
        log_file("builds/provenance"),
    benchmark:
        benchmark_file("builds/provenance")
    threads: CORES
    resources:
        cpus_per_task=CORES,
    params:
        **stage("builds.provenance"),
        config=hashlib.sha256(json.dumps(config).encode()).hexdigest(),
        benchmarks=result("benchmarks"),
    message:
        "Commit, config, versions and processor of the build"
    script:
        "../../scripts/make.py"


rule archive:
    input:
        results=[
            *figure_files(),
            *caption_files(),
            *map(table, READ),
            *rules.claims.output,
            *rules.manifest.output,
            *rules.provenance.output,
        ],
        sources=archived_sources(),
        readme=source("workflow/templates/ARCHIVE.md"),
    output:
        directory(f"archive/{config['prefix'] or 'paper'}"),
    log:
        log_file("builds/archive"),
    benchmark:
        benchmark_file("builds/archive")
    params:
        figures=archived_figures(),
        megabytes=config["archive"]["megabytes"],
        code=source_hash("archive"),
    message:
        "An archive of the figures and what they are made from"
    script:
        "../../scripts/archive.py"
