# Pages of `snakemake --report`: a start page, the figures of each section beside their captions, the claims, the provenance.
from scripts.report.pages import escape_label, figure_pages
from workflow.config.entries import by_methods, count_points

REPORT = result("report")
REPORT_PAGES = figure_pages(
    {
        name: {
            "name": name,
            "title": title_of(name),
            "section": entry["section"],
            "file": figure_file(name),
            "png": figure_file(name, "png"),
            "rst": result(f"captions/{name}.rst"),
        }
        for name, entry in config["figures"].items()
    },
    folder=REPORT,
)
# The points of all sweeps that both this config and the paper's config have.
PAPER_SWEEPS = by_methods(PAPER)["sweeps"]
POINTS, PAPER_POINTS = (
    sum(count_points(sweeps[name]["axes"]) for name in PAPER_SWEEPS.keys() & config["sweeps"].keys())
    for sweeps in (config["sweeps"], PAPER_SWEEPS)
)
REPORT_NOTICE = {"overlays": OVERLAYS, "points": POINTS, "paper_points": PAPER_POINTS} if OVERLAYS else {}
REPORT_FILES = [
    *(page["file"] for page in REPORT_PAGES),
    *(f"{REPORT}/{name}.html" for name in ("summary", "claims", "provenance")),
]
REPORT_SOURCES = [*sources("scripts/report/*.html"), source("scripts/report/page.css")]


rule report_figures:
    input:
        [figure[kind] for page in REPORT_PAGES for figure in page["figures"] for kind in ("png", "rst")],
        REPORT_SOURCES,
    output:
        [
            report(
                page["file"],
                category="Figures",
                labels={"section": escape_label(page["section"]), "figures": escape_label(page["label"])},
            )
            for page in REPORT_PAGES
        ],
    log:
        log_file("report/figures"),
    benchmark:
        benchmark_file("report/figures")
    params:
        **stage("report.figure_pages"),
        pages=REPORT_PAGES,
        notice=REPORT_NOTICE,
    message:
        "The figures with their captions for the report"
    script:
        "../../scripts/make.py"


rule report_summary:
    input:
        REPORT_SOURCES,
        **({"findings": result("findings.md")} if HAS_ALL_CLAIMS else {}),
        claims=table("results/claims"),
        provenance=result("provenance.json"),
    output:
        summary=f"{REPORT}/summary.html",
        claims=report(f"{REPORT}/claims.html", category="Claims", labels={"page": "The paper's statements"}),
        provenance=report(
            f"{REPORT}/provenance.html", category="Provenance", labels={"page": "Where these results come from"}
        ),
    log:
        log_file("report/summary"),
    benchmark:
        benchmark_file("report/summary")
    params:
        **stage("report.summary"),
        step=config["solver"]["step"],
        pages=REPORT_PAGES,
        files={name: f"{REPORT}/{name}.html" for name in ("claims", "provenance")},
        notice=REPORT_NOTICE,
    message:
        "The start page of the report"
    script:
        "../../scripts/make.py"
