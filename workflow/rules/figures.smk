# Figures: the table `figures` of the config makes one rule for each.


def figure_file(figure, ending="pdf"):
    return f"figures/{PREFIX}{figure}.{ending}"


def figure_files(ending="pdf"):
    """The files of all figures."""
    return [figure_file(figure, ending) for figure in config["figures"]]


def caption_files(figures=config["figures"]):
    """The captions of figures, their numbers filled in."""
    return [result(f"captions/{figure}.rst") for figure in figures]


def in_message(text):
    """A text for a message, which Snakemake formats: braces, as in LaTeX, stay braces."""
    return text.replace("{", "{{").replace("}", "}}")


def refuse(figure, reason):
    """Inputs of a rule whose figure makes no sense for this machine: an error that says why, once it is asked for."""

    def refused(wildcards):
        raise WorkflowError(f"{figure_file(figure)} is not made for this machine: {reason}")

    return [refused]


for figure, entry in (config["figures"] | config["figures_on_request"]).items():

    rule:
        name:
            f"plot_{figure}"
        input:
            **{role: table(*reference.split("/")) for role, reference in entry["tables"].items()},
        output:
            pdf=figure_file(figure),
            png=figure_file(figure, "png"),
        log:
            log_file(f"figures/{figure}"),
        benchmark:
            benchmark_file(f"figures/{figure}")
        threads: 1
        resources:
            mem_mb=1500,
            runtime=10,
        params:
            figure=figure,
            kinds={role: kind_of(reference) for role, reference in entry["tables"].items()},
            settings=entry.get("settings", {}),
            asked=asked,
            code=source_hash("draw", f"figures/plots/{figure}"),
        message:
            f"Draw {figure}: {in_message(entry['title'])}"
        script:
            "../../scripts/draw.py"


# Of all figures, and of those that only who asks for them makes.
for name, figures, message in (
    ("captions", config["figures"], "Captions of all figures"),
    ("captions_on_request", config["figures_on_request"], "Captions of the figures on request"),
):
    RULES[name] = {
        "stage": "figures.captions",
        "message": message,
        "outputs": caption_files(figures),
        "place": f"figures/{name}",
        "runtime": 10,
    } | read_tables(
        reference
        for entry in figures.values()
        for key in ("tables", "caption_tables")
        for reference in entry.get(key, {}).values()
    )
    RULES[name]["input"]["templates"] = [f"workflow/report/{figure}.rst" for figure in figures]
    RULES[name]["params"] |= {"figures": figures, "paper": not OWN_MACHINE}

# Figures that make no sense for this machine.
for figure, reason in loaded.refused.items():

    rule:
        name:
            f"refuse_{figure}"
        input:
            refuse(figure, reason),
        output:
            figure_file(figure),
            figure_file(figure, "png"),
        localrule: True
        message:
            f"{figure} is the paper's own"
