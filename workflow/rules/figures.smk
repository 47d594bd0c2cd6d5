# Figures: the table `figures` of the config makes one rule for each, with its own caption in the report.


def figure_files(ending="pdf"):
    """The files of all figures."""
    return [figure_file(figure, ending) for figure in config["figures"]]


def figure_file(figure, ending):
    return f"figures/{PREFIX}{figure}.{ending}"


def figure_tables(entry):
    """The tables of a figure's entry, by the names under which its plot script knows them."""
    return {role: table(*reference.split("/")) for role, reference in entry["tables"].items()}


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
                caption=f"../report/{figure}.rst",
                category="Figures",
                labels={"figure": figure, "title": entry["title"], "section": entry["section"]},
            ),
        log:
            log_file("figures", figure),
        benchmark:
            benchmark_file("figures", figure)
        threads: 1
        resources:
            mem_mb=1000,
            runtime=10,
        params:
            figure=figure,
            settings=entry.get("settings", {}),
            code=source_hash("plot_figure", f"plots/{figure}"),
        message:
            f"Draw {figure}: {entry['title']}"
        script:
            "../../scripts/plot_figure.py"
