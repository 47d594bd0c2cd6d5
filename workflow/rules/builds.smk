# What a build holds, and where it comes from: the last files of all.


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
        [result("checked.txt")] if CHECKS_RESULTS else [],
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
        versions=versions([*package_names(), "snakemake"]),
        benchmarks=result("benchmarks"),
    message:
        "Commit, config, versions and processor of the build"
    script:
        "../../scripts/make.py"


rule archive:
    input:
        results=archived_results(),
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
