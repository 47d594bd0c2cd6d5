# Figures: the table `figures` of the config makes one rule for each.


def figure_file(figure, ending="pdf"):
    return f"figures/{PREFIX}{figure}.{ending}"


def figure_files(ending="pdf"):
    """The files of all figures."""
    return [figure_file(figure, ending) for figure in config["figures"]]


def caption_files():
    """The captions of all figures, their numbers filled in."""
    return [result(f"captions/{figure}.rst") for figure in config["figures"]]


def in_message(text):
    """A text for a message, which Snakemake formats: braces, as in LaTeX, stay braces."""
    return text.replace("{", "{{").replace("}", "}}")


for figure, entry in config["figures"].items():

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


RULES["captions"] = {
    "stage": "figures.captions",
    "message": "Captions of all figures",
    "outputs": caption_files(),
    "place": "figures/captions",
    "runtime": 10,
} | read_tables(
    reference
    for entry in config["figures"].values()
    for key in ("tables", "caption_tables")
    for reference in entry.get(key, {}).values()
)
RULES["captions"]["input"]["templates"] = [f"workflow/report/{figure}.rst" for figure in config["figures"]]
RULES["captions"]["params"]["figures"] = config["figures"]
