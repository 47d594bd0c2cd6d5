# Figures and their captions.


rule plot:
    input:
        unpack(tables_of_figure),
    output:
        pdf=figure_file("{figure}"),
        png=report(
            figure_file("{figure}", "png"),
            caption="../report/figure.rst",
            category=section_in_report,
            labels=labels_in_report,
        ),
    log:
        log_file("figures/{figure}"),
    benchmark:
        benchmark_file("figures/{figure}")
    wildcard_constraints:
        figure=one_of([*FIGURES, *NO_FIGURES]),
    resources:
        mem_mb=1500,
    params:
        settings=lambda wildcards: FIGURES[wildcards.figure].get("settings", {}),
        expected=expected,
        code=lambda wildcards: source_hash("draw", f"figures/plots/{wildcards.figure}"),
    message:
        "Draw {wildcards.figure}"
    script:
        "../../scripts/draw.py"


rule captions:
    input:
        read=map(table, references_of(config["figures"])),
        templates=[source(f"scripts/figures/plots/{figure}.rst") for figure in config["figures"]],
    output:
        caption_files(),
    log:
        log_file("figures/captions"),
    benchmark:
        benchmark_file("figures/captions")
    params:
        **stage("figures.captions", scripts=lambda wildcards: caption_scripts(config["figures"])),
        figures=config["figures"],
        references=references_of(config["figures"]),
        paper=not OWN_CONVEYOR,
    message:
        "Captions of all figures"
    script:
        "../../scripts/make.py"


rule caption_on_request:
    input:
        read=lambda wildcards: [table(reference) for reference in references_of(captioned(wildcards))],
        templates=[source("scripts/figures/plots/{figure}.rst")],
    output:
        [result("captions/{figure}.rst")],
    log:
        log_file("figures/caption_{figure}"),
    benchmark:
        benchmark_file("figures/caption_{figure}")
    wildcard_constraints:
        figure=one_of(config["figures_on_request"]),
    params:
        **stage("figures.captions", scripts=lambda wildcards: caption_scripts([wildcards.figure])),
        figures=captioned,
        references=lambda wildcards: references_of(captioned(wildcards)),
        paper=not OWN_CONVEYOR,
    message:
        "Caption of {wildcards.figure}"
    script:
        "../../scripts/make.py"
