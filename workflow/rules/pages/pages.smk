# Pages of the documentation, the article and the site, made from results.
from pathlib import Path

from conveyor import __version__
from conveyor_pipeline.config.schema import json_schema
from conveyor_pipeline.config.stages import STAGES


include: "common.smk"


# Pages made from the paper's config are part of the repository: in docs/, some of them in the project's folder.
DOCS, PROJECT = (result("docs/"), result("docs/")) if PREFIX else ("docs/", "")
# Begin of the names of pages about another conveyor, which the repository keeps as well.
EXAMPLE = config["prefix"] and f"{config['prefix']}_"
# Pages that are copies of results.
COPIES = {
    f"{DOCS}claims.md": result("claims.md"),
    f"docs/{EXAMPLE}calibration.md": result("calibration.md"),
    f"docs/{EXAMPLE}chart.md": result("operating/chart.md"),
}
# Inputs that fill the template of each page.
PAGES = {
    "certificates": tables_of("orbits/certificates", "orbits/certified_bifurcations", "orbits/certified_chaos"),
    "checked": tables_of("results/theory", "results/map_check", "operating/bodies"),
    "tables": {},
}
# The tables behind the facts, by their roles in scripts/conveyor_pipeline/pages/facts.py.
FACTS = {
    **tables_of("results/claims", "lyapunov/spectrum", "orbits/cascade", "critical/edge", "critical/edge_euler"),
    **tables_of("sweeps/on_plate", "operating/transit", "operating/advice", "operating/bodies"),
    **PRECISION,
    **PAGES["certificates"],
    "estimate": table("estimates/phase"),
    "estimate_euler": table("estimates/phase_euler"),
    "fit": table("regressions/height"),
    "moved": table("results/moved_impacts"),
    "lengths": table("operating/track_lengths"),
    "drives": table("excitation/clean_drive"),
}
KEPT_PAGES = ("README.md", "metadata.yaml", "codecheck.yml")
ARTICLE_PARTS = {
    "facts": result("facts.json"),
    "config": [os.path.relpath(file) for file in DEFAULT_FILES],
    "captions": caption_files(),
    "uncertainty": result("uncertainty.json"),
}
# Figures of the paper's conveyor that README and guides show.
PICTURES = ("overview", "work_precision", "fig04")
DIAGRAMS = {name: f"{DOCS}diagrams/{name}.png" for name in ("cycle", "contact", "friction", "states")}
ARTICLE = source("workflow/rules/pages/article.md")
SITE_TEMPLATES = [ARTICLE, *sources("workflow/rules/pages/site/*.md")]
SITE_PAGES = [result(f"site_pages/{Path(file).name}") for file in SITE_TEMPLATES]
LIBRARY = modules("conveyor/**/*")
# The reference of tables lists the columns of all modules with a mapping TABLES.
STAGE_MODULES = [module for package in STAGES.values() for module in modules(f"{package.replace('.', '/')}/*")]


rule page:
    """A page of the documentation."""
    input:
        unpack(inputs_of_page),
        template=source("workflow/rules/pages/{page}.md"),
    output:
        f"{DOCS}{{page}}.md",
    log:
        log_file("docs/{page}"),
    wildcard_constraints:
        page=one_of(PAGES),
    params:
        **stage(
            "conveyor_pipeline.pages.{page}_page",
            scripts=lambda wildcards: STAGE_MODULES if wildcards.page == "tables" else [],
        ),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule companion:
    """The interactive page."""
    input:
        sources("scripts/conveyor_pipeline/pages/companion/*.js*")
        + sources("scripts/conveyor_pipeline/pages/companion/page.*"),
        maps=[table(f"sweeps/{name}") for name in config["companion"]["maps"]],
    output:
        f"{DOCS}companion.html",
    log:
        log_file("docs/companion"),
    params:
        **stage("conveyor_pipeline.pages.companion.build"),
        settings={name: config[name] for name in ("model", "solver", "companion")},
    script:
        "../../../scripts/conveyor_pipeline/make.py"


# The numbers of README, article, site and metadata.
rule facts:
    """The numbers of all pages."""
    input:
        unpack(tables_of_facts),
        provenance=result("provenance.json"),
    output:
        result("facts.json"),
    log:
        log_file("docs/facts"),
    params:
        **stage("conveyor_pipeline.pages.facts"),
        values={
            "version": __version__,
            "prefix": config["prefix"],
            "step": config["solver"]["step"],
            "tighter": config["uncertainty"]["tighter"],
            "figures": {
                name: {"title": title_of(name), "section": entry["section"]}
                for name, entry in config["figures"].items()
            },
        },
    script:
        "../../../scripts/conveyor_pipeline/make.py"


# The README, the form of the journal ReScience, and the manifest of CODECHECK.
rule kept_pages:
    """README and metadata."""
    input:
        facts=result("facts.json"),
        templates=[source(f"workflow/rules/pages/{name}") for name in KEPT_PAGES],
    output:
        [f"{PROJECT}{name}" for name in KEPT_PAGES],
    log:
        log_file("docs/kept_pages"),
    params:
        **stage("conveyor_pipeline.pages.pages"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule article:
    """The article."""
    input:
        figure_files(),
        **ARTICLE_PARTS,
        templates=[ARTICLE],
        frame=source("workflow/rules/pages/article.typ"),
    output:
        text=result("article/article.md"),
        pdf=result("article.pdf"),
    log:
        log_file("docs/article"),
    params:
        **stage("conveyor_pipeline.pages.article"),
        medium="print",
        folder=lambda wildcards, input: f"{os.path.dirname(input[0])}/",
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule site_pages:
    """The pages of the site."""
    input:
        **ARTICLE_PARTS,
        templates=SITE_TEMPLATES,
        schema=source("config/schema.json"),
    output:
        SITE_PAGES,
    log:
        log_file("docs/site_pages"),
    params:
        **stage("conveyor_pipeline.pages.pages"),
        medium="site",
        folder="figures/",
        library=LIBRARY,
    script:
        "../../../scripts/conveyor_pipeline/make.py"


# The pictures that explain how the solver works: snakemake --force docs/diagrams/cycle.png
rule diagrams:
    """The diagrams of the site."""
    output:
        **DIAGRAMS,
    log:
        log_file("docs/diagrams"),
    params:
        **stage("conveyor_pipeline.pages.diagrams"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule site:
    """The site."""
    input:
        article=result("article.pdf"),
        companion=f"{DOCS}companion.html",
        pages=[
            *SITE_PAGES,
            source("scripts/conveyor/README.md"),
            *(f"{DOCS}{page}.md" for page in PAGES),
        ],
        guides=sources("docs/guides/*.md"),
        # Pages and pictures of other conveyors, and pictures of the paper's figures, to which the guides refer.
        examples=[file for name in ("bowl", "feeder", "measured") for file in sources(f"docs/{name}_*.*")],
        pictures=[source(f"docs/{name}.png") for name in PICTURES],
        diagrams=DIAGRAMS.values(),
        style=source("scripts/conveyor_pipeline/pages/site.css"),
        pdf=figure_files(),
        png=figure_files(ending="png"),
    output:
        directory(result("site")),
    log:
        log_file("docs/site"),
    resources:
        mem_mb=1500,
    params:
        code=lambda wildcards: code_of("conveyor_pipeline/build_site", *LIBRARY),
    script:
        "../../../scripts/conveyor_pipeline/build_site.py"


# The pictures of the README, and what the site shows of other conveyors:
#   snakemake docs/bowl_transit.png docs/bowl_basin_stability.png docs/bowl_drive.png --configfile config/examples/bowl.yaml
#   snakemake docs/feeder_transit.png docs/feeder_chart.md --configfile docs/guides/feeder.yaml
#   snakemake docs/measured_calibration.png docs/measured_calibration.md --configfile config/examples/measured.yaml
#   snakemake docs/measured_chart.md --configfile config/examples/measured.yaml results/measured/calibrated.yaml
rule picture:
    """A figure as a picture of the documentation."""
    input:
        png=figure_file("{figure}", "png"),
    output:
        f"docs/{EXAMPLE}{{figure}}.png",
    log:
        log_file("docs/{figure}"),
    wildcard_constraints:
        figure="operating|transit|basin_stability|drive|calibration" if EXAMPLE else one_of(PICTURES),
    params:
        **stage("conveyor_pipeline.pages.pictures"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule copied_page:
    """A page of the documentation that is a copy of a result."""
    input:
        lambda wildcards: COPIES[wildcards.page],
    output:
        "{page}",
    log:
        log_file("docs/copied/{page}"),
    wildcard_constraints:
        page=one_of(COPIES),
    localrule: True
    run:
        Path(output[0]).write_bytes(Path(input[0]).read_bytes())


# The JSON Schema of the config, which the repository keeps for editors: snakemake --force config/schema.json
rule schema:
    """The JSON Schema of the config."""
    output:
        "config/schema.json",
    log:
        log_file("docs/schema"),
    localrule: True
    run:
        Path(output[0]).write_text(json_schema(), encoding="utf-8")
