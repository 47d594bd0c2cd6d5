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


def jobs_of(reference):
    """The benchmark files of the jobs that a table SECTION/NAME needs."""
    section, name = reference.split("/")
    if section == "sweeps":
        shards = math.ceil(count_points(config["sweeps"][name]["axes"]) / POINTS_PER_JOB)
        return [benchmark_file("runs", f"{name}/{k}") for k in range(shards)] + [benchmark_file(section, name)]
    if section == "regressions":
        return jobs_of(f"critical/{config['regressions'][name]['critical']}") + [benchmark_file(section, name)]
    if section == "orbits":
        proved = [benchmark_file("orbits", "certificates")] if name.startswith("certif") else []
        return [benchmark_file("orbits", "orbits"), *proved]
    if section == "lyapunov":
        return jobs_of("attractors/strobes") + [benchmark_file(section, name)]
    if section == "wall_times":
        return jobs_of(f"precision/{name}") + [benchmark_file(section, name)]
    return [benchmark_file("accuracy" if section == "results" else section, name)]


def costs():
    """A param: the tables of each figure and the benchmark files of all jobs that it needs."""
    found = {}
    for figure, entry in config["figures"].items():
        references = list(entry["tables"].values())
        files = {file for reference in references for file in jobs_of(reference)}
        found[figure] = {"tables": references, "files": sorted(files | {benchmark_file("figures", figure)})}
    return found


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
        figures=costs(),
        code=source_hash("figure_costs"),
    message:
        "What each figure costs"
    script:
        "../../scripts/figure_costs.py"


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
