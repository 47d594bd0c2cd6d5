# Figures and their captions.


rule plot:
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
        templates=[source(f"workflow/report/{figure}.rst") for figure in config["figures"]],
    output:
        caption_files(),
    log:
        log_file("figures/captions"),
    benchmark:
        benchmark_file("figures/captions")
    params:
        **stage("figures.captions"),
        figures=config["figures"],
        references=references_of(config["figures"]),
        paper=not OWN_CONVEYOR,
    message:
        "Captions of all figures"
    script:
        "../../scripts/make.py"


rule captions_on_request:
    input:
        read=map(table, references_of(config["figures_on_request"])),
        templates=[source(f"workflow/report/{figure}.rst") for figure in config["figures_on_request"]],
    output:
        caption_files(config["figures_on_request"]),
    log:
        log_file("figures/captions_on_request"),
    benchmark:
        benchmark_file("figures/captions_on_request")
    params:
        **stage("figures.captions"),
        figures=config["figures_on_request"],
        references=references_of(config["figures_on_request"]),
        paper=not OWN_CONVEYOR,
    message:
        "Captions of the figures on request"
    script:
        "../../scripts/make.py"
