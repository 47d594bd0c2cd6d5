# The page to play with: one HTML file, made on the paper's config for the documentation.


rule companion:
    input:
        maps=[table("sweeps", name) for name in config["companion"]["maps"]],
        # What the page is put together from, as no import leads there.
        sources=[f"scripts/docs/companion/{name}" for name in ("page.html", "page.css", "solver.js", "page.js")],
    output:
        "docs/companion.html" if not PREFIX else result("companion.html"),
    log:
        log_file("docs", "companion"),
    benchmark:
        benchmark_file("docs", "companion")
    threads: 1
    resources:
        mem_mb=1000,
        runtime=10,
    params:
        settings={name: config[name] for name in ("model", "solver", "companion")},
        code=source_hash("companion"),
    message:
        "The page to play with"
    script:
        "../../scripts/companion.py"
