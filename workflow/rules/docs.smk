# Pages of the documentation, made from results.
RULES["certificates_page"] = {
    "stage": "docs.certificates_page",
    "message": "What is proved, in words",
    "input": tables_of("orbits", "certificates", "certified_bifurcations", "certified_chaos"),
    "output": {"page": page("certificates.md")},
    "place": "docs/certificates",
}

RULES["identification_page"] = {
    "stage": "docs.identification_page",
    "message": "What the paper's numbers say of its parameters, in words",
    "input": {
        "template": "workflow/templates/identification.md",
        **tables_of("identification", *TABLES["identification"][1:]),
    },
    "output": {"page": page("identification.md")},
    "place": "docs/identification",
}

RULES["claims_page"] = {
    "stage": "docs.copy_page",
    "message": "The page of claims that later builds are compared with",
    "input": {"page": result("claims.md")},
    "output": {"page": page("claims.md")},
    "place": "docs/claims",
}

RULES["cluster_page"] = {
    "stage": "docs.cluster_page",
    "message": "What large sweeps cost",
    "input": {"scaling": table("results", "scaling"), "template": "workflow/templates/cluster.md"},
    "output": {"page": page("cluster.md")},
    "place": "docs/cluster",
    "params": {"settings": config["sharing"]},
}

RULES["companion"] = {
    "stage": "docs.companion.build",
    "message": "The page to play with",
    # What the page is put together from, as no import leads there.
    "depends": [f"scripts/docs/companion/{name}" for name in ("page.html", "page.css", "solver.js", "page.js")],
    "input": {"maps": [table("sweeps", name) for name in config["companion"]["maps"]]},
    "output": {"page": page("companion.html")},
    "place": "docs/companion",
    "params": {
        "kinds": {"maps": "sweeps"},
        "settings": {name: config[name] for name in ("model", "solver", "companion")},
    },
}

# What the pages tell, from these tables.
FACTS = {
    **tables_of("results", "claims", "benchmark"),
    "edge": table("critical", "edge"),
    "edge_euler": table("critical", "edge_euler"),
    "estimate": table("estimates", "phase"),
    "estimate_euler": table("estimates", "phase_euler"),
    "fit": table("regressions", "height"),
    **tables_of("lyapunov", "spectrum"),
    **tables_of("orbits", "cascade", "certificates", "certified_bifurcations", "certified_chaos"),
}
KINDS_OF_FACTS = {
    "edge": "critical",
    "edge_euler": "critical",
    "estimate": "estimates",
    "estimate_euler": "estimates",
    "fit": "regressions",
}


def template(name):
    return f"workflow/templates/{name}"


def beside_the_sources(name):
    """A file in the project's folder if it is made from the paper's config."""
    return result(f"docs/{name}") if PREFIX else name


def pages_rule(name, message, templates, outputs, **rest):
    """The rule of pages that are made from templates."""
    inputs, params = rest.pop("input", {}), rest.pop("params", {})
    RULES[name] = {
        "stage": "docs.pages",
        "message": message,
        "input": {**FACTS, "templates": templates, **inputs},
        "outputs": outputs,
        "place": f"docs/{name}",
        "params": {
            "kinds": KINDS_OF_FACTS,
            "figures": {
                figure: {key: entry[key] for key in ("title", "section")} for figure, entry in config["figures"].items()
            },
            "values": {
                "prefix": config["prefix"],
                "step": config["solver"]["step"],
                "tighter": config["uncertainty"]["tighter"],
            },
            **params,
        },
        **rest,
    }


# What the paper does not say, for README and report.
pages_rule("findings", "What was found beyond the paper", [template("findings.md")], [result("findings.md")])

# The README, and the form of the journal ReScience and the manifest of CODECHECK, which name this project's files.
KEPT = ("README.md", "metadata.yaml", "codecheck.yml")
pages_rule(
    "kept_pages",
    "README and metadata",
    [*map(template, KEPT)],
    [*map(beside_the_sources, KEPT)],
    input={"findings": result("findings.md")},
)

CLAIMED = {
    name: [table(*reference.split("/")) for reference in claim["tables"].values()]
    for name, claim in config["claims"].items()
}

RULES["costs"] = {
    "stage": "docs.costs",
    "message": "What each figure and claim costs",
    "depends": [*figure_files(), *sorted({file for files in CLAIMED.values() for file in files})],
    "output": {"costs": result("costs.json")},
    "place": "docs/costs",
    "params": {
        "files": {figure: [figure_file(figure)] for figure in config["figures"]} | CLAIMED,
        "configfiles": [str(file) for file in workflow.overwrite_configfiles],
    },
}

RULES["figure_costs"] = {
    "stage": "docs.figure_costs",
    "message": "What each figure costs",
    "input": {"costs": result("costs.json")},
    "output": {"page": page("figures.md")},
    "place": "docs/figures",
    "params": {"figures": list(config["figures"])},
}

# The article, and the site, which shows it as well.
CONFIG_FILES = [f"config/{name}.yaml" for name in ("config", *STAGES)]
TOLD = {
    "captions": caption_files(),
    "costs": result("costs.json"),
    "uncertainty": result("uncertainty.json"),
    "proved": page("certificates.md"),
}


def written_keys(wildcards):
    """The keys of the paper's config, with the comments there."""
    return [key._asdict() for key in all_written(CONFIG_FILES)]


def known_keys(wildcards):
    """All keys that a config may have."""
    return [key._asdict() for key in config_keys(json.loads(json_schema()))]


pages_rule(
    "article_text",
    "The text of the article",
    [template("article.md")],
    [result("article/article.md")],
    input=TOLD,
    depends=CONFIG_FILES,
    params={"medium": "print", "folder": f"/figures/{PREFIX}", "written": written_keys},
)

RULES["article"] = {
    "stage": "docs.article",
    "message": "The article",
    "depends": figure_files(),
    "input": {"text": result("article/article.md"), "frame": template("article.typ")},
    "output": {"article": result("article.pdf")},
    "place": "docs/article",
}

SITE_TEMPLATES = sorted(Path("workflow/templates/site").glob("*.md"))
LIBRARY = sorted(
    str(path.relative_to(SCRIPTS).with_suffix(""))
    for path in (SCRIPTS / "conveyor").rglob("*.py")
    if path.name != "__init__.py"
)

pages_rule(
    "site_pages",
    "The pages of the site",
    [template("article.md"), *(template(f"site/{path.name}") for path in SITE_TEMPLATES)],
    [result(f"site_pages/{path.name}") for path in (Path("article.md"), *SITE_TEMPLATES)],
    input=TOLD,
    depends=CONFIG_FILES,
    params={"medium": "site", "folder": "figures/", "written": written_keys, "known": known_keys, "library": LIBRARY},
)


rule site:
    input:
        article=result("article.pdf"),
        companion=page("companion.html"),
        pages=RULES["site_pages"]["outputs"],
        style="scripts/docs/site.css",
        pdf=figure_files(),
        png=figure_files("png"),
    output:
        directory(result("site")),
    log:
        log_file("docs/site"),
    benchmark:
        benchmark_file("docs/site")
    threads: 1
    resources:
        mem_mb=1500,
        runtime=10,
    params:
        code=source_hash("build_site", *LIBRARY),
    message:
        "The site"
    script:
        "../../scripts/build_site.py"


# Pictures of the README.
for name in ("overview", "work_precision"):
    RULES[f"{name}_picture"] = {
        "stage": "docs.pictures",
        "message": f"The picture {name} of the documentation",
        "depends": [figure_file(name, "png")],
        "output": {"picture": page(f"{name}.png")},
        "place": f"docs/{name}",
        "params": {"file": figure_file(name, "png")},
    }
