# Pages of `snakemake --report`: a start page, the figures of each section beside their captions, the claims, the provenance.


rule report_figures:
    input:
        [figure[kind] for page in REPORT_PAGES.values() for figure in page["figures"] for kind in ("png", "rst")],
        sources("scripts/report/*.html"),
        source("scripts/report/page.css"),
    output:
        **{
            name: report(
                report_file(name),
                category="Figures",
                labels={"section": escape_label(page["section"]), "figures": escape_label(page["label"])},
            )
            for name, page in REPORT_PAGES.items()
        },
    log:
        log_file("report/figures"),
    benchmark:
        benchmark_file("report/figures")
    params:
        **stage("report.figure_pages"),
        pages=REPORT_PAGES,
        told=REPORT_NOTICE,
    message:
        "The figures with their captions for the report"
    script:
        "../../scripts/make.py"


rule report_summary:
    input:
        sources("scripts/report/*.html"),
        source("scripts/report/page.css"),
        **({"findings": result("findings.md")} if REPORTS_FINDINGS else {}),
        claims=table("results/claims"),
        provenance=result("provenance.json"),
    output:
        summary=report_file("summary"),
        claims=report(report_file("claims"), category="Claims", labels={"page": "The paper's statements"}),
        provenance=report(
            report_file("provenance"), category="Provenance", labels={"page": "Where these results come from"}
        ),
    log:
        log_file("report/summary"),
    benchmark:
        benchmark_file("report/summary")
    params:
        **stage("report.summary"),
        step=config["solver"]["step"],
        pages=[
            {"heading": page["heading"], "file": report_file(name), "figures": page["figures"]}
            for name, page in REPORT_PAGES.items()
        ],
        files={name: report_file(name) for name in ("claims", "provenance")},
        told=REPORT_NOTICE,
    message:
        "The start page of the report"
    script:
        "../../scripts/make.py"
