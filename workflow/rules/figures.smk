# Figures and their captions.
FIGURES = config["figures"] | config["figures_on_request"]


def tables_of_figure(wildcards):
    """The tables that a figure draws, by their roles; an error for a figure that makes no sense for this machine."""
    if reason := REFUSED.get(wildcards.figure):
        raise WorkflowError(f"{figure_file(wildcards.figure)} is not made for this machine: {reason}")
    return {role: table(reference) for role, reference in FIGURES[wildcards.figure]["tables"].items()}


def references_of_captions(figures):
    """The tables that the captions of figures read."""
    roles = [entry.get(key, {}) for entry in figures.values() for key in ("tables", "caption_tables")]
    return sorted({reference for of_figure in roles for reference in of_figure.values()})


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
        figure=one_of([*FIGURES, *REFUSED]),
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
        read=map(table, references_of_captions(config["figures"])),
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
        references=references_of_captions(config["figures"]),
        paper=not OWN_MACHINE,
    message:
        "Captions of all figures"
    script:
        "../../scripts/make.py"


use rule captions as captions_on_request with:
    input:
        read=map(table, references_of_captions(config["figures_on_request"])),
        templates=[source(f"workflow/report/{figure}.rst") for figure in config["figures_on_request"]],
    output:
        caption_files(config["figures_on_request"]),
    log:
        log_file("figures/captions_on_request"),
    benchmark:
        benchmark_file("figures/captions_on_request")
    params:
        figures=config["figures_on_request"],
        references=references_of_captions(config["figures_on_request"]),
    message:
        "Captions of the figures on request"
