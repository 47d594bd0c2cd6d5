# Figures and their captions.


rule plot:
    """A figure."""
    input:
        unpack(tables_of_figure),
    output:
        pdf=figure_file("{figure}"),
        png=figure_file("{figure}", "png"),
    log:
        log_file("figures/{figure}"),
    benchmark:
        benchmark_file("figures/{figure}")
    wildcard_constraints:
        figure=one_of([*FIGURES, *NO_FIGURES]),
    params:
        **stage("conveyor_pipeline.figures.plots", scripts=lambda wildcards: figure_modules(wildcards.figure)),
        settings=lambda wildcards: settings_of_figure(wildcards.figure),
        figure="{figure}",
    script:
        "../../scripts/conveyor_pipeline/make.py"


# On a cluster, a job of its own would wait longer than it runs.
rule caption:
    """The caption of a figure."""
    input:
        # Snakemake's report shows the picture with the caption below it, so that it needs both.
        report(
            figure_file("{figure}", "png"),
            caption="../report/figure.rst",
            category=section_in_report,
            labels=labels_in_report,
        ),
        unpack(tables_of_caption),
        template=lambda wildcards: source(caption_file(wildcards.figure)),
    output:
        caption=result("captions/{figure}.rst"),
    log:
        log_file("figures/caption_{figure}"),
    benchmark:
        benchmark_file("figures/caption_{figure}")
    wildcard_constraints:
        figure=one_of([*FIGURES, *NO_FIGURES]),
    localrule: True
    params:
        **stage(
            "conveyor_pipeline.figures.captions",
            scripts=lambda wildcards: figure_modules(wildcards.figure, "caption_numbers"),
        ),
        settings=lambda wildcards: settings_of_figure(wildcards.figure),
        figure="{figure}",
        paper=not PREFIX,
    script:
        "../../scripts/conveyor_pipeline/make.py"
