# Figures: the table `figures` of the config makes one rule for each, with its own caption in the report.


def figure_files(ending="pdf"):
    """The files of all figures."""
    return [figure_file(figure, ending) for figure in config["figures"]]


def figure_file(figure, ending):
    return f"figures/{PREFIX}{figure}.{ending}"


def figure_tables(entry):
    """The tables of a figure's entry, by the names under which its plot script knows them."""
    return {role: table(*reference.split("/")) for role, reference in entry["tables"].items()}


def caption_file(figure):
    """The caption of a figure, its numbers filled in."""
    return result(f"captions/{figure}.rst")


def caption_files():
    return [caption_file(figure) for figure in config["figures"]]


for figure, entry in config["figures"].items():

    rule:
        name:
            f"plot_{figure}"
        input:
            **figure_tables(entry),
        output:
            pdf=figure_file(figure, "pdf"),
            png=report(
                figure_file(figure, "png"),
                caption=f"../../{caption_file(figure)}",
                category="Figures",
                labels={"figure": figure, "title": entry["title"], "section": entry["section"]},
            ),
        log:
            log_file("figures", figure),
        benchmark:
            benchmark_file("figures", figure)
        threads: 1
        resources:
            mem_mb=1500,
            runtime=10,
        params:
            figure=figure,
            settings=entry.get("settings", {}),
            code=source_hash("plot_figure", f"plots/{figure}"),
        message:
            f"Draw {figure}: {entry['title']}"
        script:
            "../../scripts/plot_figure.py"


def caption_references():
    """The tables that captions need, as SECTION/NAME, sorted."""
    figures = config["figures"].values()
    tables = (entry[key] for entry in figures for key in ("tables", "caption_tables") if key in entry)
    return sorted({reference for one in tables for reference in one.values()})


rule captions:
    input:
        tables=[table(*reference.split("/")) for reference in caption_references()],
        templates=[f"workflow/report/{figure}.rst" for figure in config["figures"]],
    output:
        caption_files(),
    log:
        log_file("figures", "captions"),
    benchmark:
        benchmark_file("figures", "captions")
    localrule: True
    params:
        figures=config["figures"],
        references=caption_references(),
        code=source_hash("captions"),
    message:
        "Captions of all figures"
    script:
        "../../scripts/captions.py"


# Pages of the documentation, made on the paper's config only.
rule figure_costs:
    input:
        figure_files(),
    output:
        "docs/figures.md" if not PREFIX else result("figures.md"),
    log:
        log_file("docs", "figures"),
    localrule: True
    params:
        figures=list(config["figures"]),
        configfiles=[str(file) for file in workflow.overwrite_configfiles],
        code=source_hash("figure_costs"),
    message:
        "What each figure costs"
    script:
        "../../scripts/figure_costs.py"


rule readme:
    input:
        template="workflow/templates/README.md",
        claims=result("claims.parquet"),
        benchmark=result("benchmark.parquet"),
        edge=table("critical", "edge"),
        edge_euler=table("critical", "edge_euler"),
        spectrum=table("lyapunov", "spectrum"),
        cascade=table("orbits", "cascade"),
    output:
        "README.md" if not PREFIX else result("README.md"),
    log:
        log_file("docs", "readme"),
    localrule: True
    params:
        figures={name: {key: entry[key] for key in ("title", "section")} for name, entry in config["figures"].items()},
        code=source_hash("readme"),
    message:
        "The README"
    script:
        "../../scripts/readme.py"


rule claims_page:
    input:
        result("claims.md"),
    output:
        "docs/claims.md" if not PREFIX else result("claims_page.md"),
    log:
        log_file("docs", "claims"),
    localrule: True
    params:
        code=source_hash("copy_page"),
    message:
        "The page of claims that later builds are compared with"
    script:
        "../../scripts/copy_page.py"


rule gallery:
    input:
        figure_files("png"),
    output:
        "docs/gallery.png" if not PREFIX else result("gallery.png"),
    log:
        log_file("docs", "gallery"),
    localrule: True
    params:
        names=list(config["figures"]),
        columns=4,
        code=source_hash("gallery"),
    message:
        "All figures side by side"
    script:
        "../../scripts/gallery.py"


rule readme_chart:
    input:
        figure_file("work_precision", "png"),
    output:
        "docs/work_precision.png" if not PREFIX else result("work_precision.png"),
    log:
        log_file("docs", "readme_chart"),
    localrule: True
    params:
        names=["work_precision"],
        columns=1,
        code=source_hash("gallery"),
    message:
        "The chart of the README"
    script:
        "../../scripts/gallery.py"
