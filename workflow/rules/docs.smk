# Pages of the documentation, made from results.
RULES["certificates_page"] = {
    "stage": "docs.certificates_page",
    "message": "What is proved, in words",
    "input": tables_of("orbits", "certificates", "certified_bifurcations", "certified_chaos"),
    "output": {"page": page("certificates.md")},
    "place": "docs/certificates",
}

RULES["claims_page"] = {
    "stage": "docs.copy_page",
    "message": "The page of claims that later builds are compared with",
    "input": {"page": result("claims.md")},
    "output": {"page": page("claims.md")},
    "place": "docs/claims",
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

RULES["readme"] = {
    "stage": "docs.readme",
    "message": "The README",
    "input": {
        "template": "workflow/templates/README.md",
        **tables_of("results", "claims", "benchmark"),
        "edge": table("critical", "edge"),
        "edge_euler": table("critical", "edge_euler"),
        **tables_of("lyapunov", "spectrum"),
        **tables_of("orbits", "cascade"),
    },
    "output": {"page": result("docs/README.md") if PREFIX else "README.md"},
    "place": "docs/readme",
    "params": {
        "kinds": {"edge": "critical", "edge_euler": "critical"},
        "figures": {
            name: {key: entry[key] for key in ("title", "section")} for name, entry in config["figures"].items()
        },
    },
}

RULES["figure_costs"] = {
    "stage": "docs.figure_costs",
    "message": "What each figure costs",
    "depends": figure_files(),
    "output": {"page": page("figures.md")},
    "place": "docs/figures",
    "params": {
        "files": {figure: figure_file(figure) for figure in config["figures"]},
        "configfiles": [str(file) for file in workflow.overwrite_configfiles],
    },
}

# Pictures of figures, by the names of their rules: which figures, and in how many columns.
for name, (figures, columns) in {
    "gallery": (list(config["figures"]), 4),
    "work_precision": (["work_precision"], 1),
}.items():
    files = {figure: figure_file(figure, "png") for figure in figures}
    RULES[f"{name}_picture"] = {
        "stage": "docs.gallery",
        "message": f"The picture {name} of the documentation",
        "depends": list(files.values()),
        "output": {"picture": page(f"{name}.png")},
        "place": f"docs/{name}",
        "params": {"files": files, "columns": columns},
    }
