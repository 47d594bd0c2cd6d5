# What a build holds, and where it comes from: the last files of all.


def tables_read():
    """The tables that figures, their captions and the claims are made from."""
    drawn = [entry.get(key, {}) for entry in config["figures"].values() for key in ("tables", "caption_tables")]
    claimed = [claim["tables"] for claim in config["claims"].values()]
    return {table(*reference.split("/")) for tables in drawn + claimed for reference in tables.values()}


def built_files():
    """All results and figures, with what the rules of these tables make beside them."""
    files = {*figure_files(), *figure_files("png"), *caption_files(), result("claims.md"), *tables_read(), *LOOKED_AT}
    for one in RULES.values():
        outputs = set(one.get("output", {}).values())
        if outputs & files:
            files |= outputs
    return sorted(files)


# Outputs that hold measured times, as their rules say.
TIMED = [one["output"][name] for one in RULES.values() for name in one.get("timed", ())]


def is_timed(file):
    """Whether measured times stand in a result."""
    return any(re.fullmatch(pattern_of(output), file) for output in TIMED)


def timed_files():
    """The results and figures that may differ from run to run: with measured times, or made from a table of them."""
    claimed = [reference for claim in config["claims"].values() for reference in claim["tables"].values()]
    read = dict.fromkeys(RULES["claims"]["output"].values(), claimed)
    for figure, entry in config["figures"].items():
        read |= dict.fromkeys((figure_file(figure), figure_file(figure, "png")), entry["tables"].values())
    made = [file for file, tables in read.items() if any(is_timed(table(*one.split("/"))) for one in tables)]
    return sorted([*made, *filter(is_timed, built_files())])


RULES["manifest"] = {
    "stage": "builds.manifest",
    "message": "The manifest of all results and figures",
    "depends": built_files(),
    "output": {"manifest": result("manifest.sha256")},
    "place": "builds/manifest",
    "runtime": 10,
    "params": {"files": built_files(), "timed": timed_files()},
}

STAGES_AND_PLOTS = [
    *(source for one in RULES.values() for source in sources_of(one)),
    *(f"figures/plots/{figure}" for figure in config["figures"]),
]

RULES["provenance"] = {
    "stage": "builds.provenance",
    "message": "Where the results come from",
    "depends": [result("manifest.sha256"), *checked_files()],
    "output": {"provenance": result("provenance.json")},
    "place": "builds/provenance",
    "cores": WHOLE_MACHINE,
    "runtime": 10,
    "params": {
        "config": hashlib.sha256(json.dumps(config).encode()).hexdigest(),
        "versions": versions([*closure("draw", *STAGES_AND_PLOTS)[1], "snakemake"]),
        "benchmarks": f"results/{PREFIX}benchmarks",
    },
}

# All that is no result: what redraws the figures, and what makes everything anew.
SOURCES = [
    *("Snakefile", "README.md", "LICENSE", "CITATION.cff", "CONTRIBUTING.md", "CHANGELOG.md", "pyproject.toml"),
    *("environment.txt", "config", "workflow", "profiles", "scripts", "tests"),
]


def sources():
    """The sources that are here, with the overlays."""
    overlays = map(os.path.relpath, workflow.overwrite_configfiles)
    inside = [file for file in overlays if not file.startswith("..")]
    return [file for file in dict.fromkeys([*SOURCES, *inside]) if Path(file).exists()]


def hash_of_sources(wildcards):
    """A param: the hash of all sources."""
    paths = [path for source in sources() for path in (Path(source), *Path(source).rglob("*"))]
    digest = hashlib.sha256()
    for path in sorted(path for path in paths if path.is_file() and path.suffix != ".pyc"):
        digest.update(f"{path}\0".encode() + path.read_bytes() + b"\0")
    return digest.hexdigest()[:16]


ARCHIVED = [
    *figure_files(),
    *caption_files(),
    *sorted(tables_read()),
    *(result(name) for name in ("claims.parquet", "claims.md", "manifest.sha256", "provenance.json")),
]


rule archive:
    input:
        ARCHIVED,
        readme="workflow/templates/ARCHIVE.md",
    output:
        directory(f"archive/{config['prefix'] or 'paper'}"),
    log:
        log_file("builds/archive"),
    benchmark:
        benchmark_file("builds/archive")
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        results=ARCHIVED,
        sources=sources(),
        figures={
            figure_file(figure): {
                "name": figure,
                "tables": {role: table(*reference.split("/")) for role, reference in entry["tables"].items()},
                "kinds": {role: kind_of(reference) for role, reference in entry["tables"].items()},
                "settings": entry.get("settings", {}),
            }
            for figure, entry in config["figures"].items()
        },
        megabytes=config["archive"]["megabytes"],
        code=hash_of_sources,
    message:
        "An archive of the figures and what they are made from"
    script:
        "../../scripts/archive.py"
