# Pages of the documentation, the article and the site, made from results.


rule certificates_page:
    input:
        **tables_of("orbits/certificates", "orbits/certified_bifurcations", "orbits/certified_chaos"),
    output:
        page=page("certificates.md"),
    log:
        log_file("docs/certificates"),
    benchmark:
        benchmark_file("docs/certificates")
    params:
        **stage("docs.certificates_page"),
    message:
        "What is proved, in words"
    script:
        "../../scripts/make.py"


rule identification_page:
    input:
        **tables_of(*(f"identification/{name}" for name in TABLES["identification"] if name != "edges")),
        template=source("workflow/templates/identification.md"),
    output:
        page=page("identification.md"),
    log:
        log_file("docs/identification"),
    benchmark:
        benchmark_file("docs/identification")
    params:
        **stage("docs.identification_page"),
    message:
        "The parameters that the paper's numbers imply, in words"
    script:
        "../../scripts/make.py"


rule claims_page:
    input:
        page=result("claims.md"),
    output:
        page=page("claims.md"),
    log:
        log_file("docs/claims"),
    benchmark:
        benchmark_file("docs/claims")
    params:
        **stage("docs.copy_page"),
    message:
        "The page of claims that the repository keeps"
    script:
        "../../scripts/make.py"


rule cluster_page:
    input:
        scaling=table("results/scaling"),
        template=source("workflow/templates/cluster.md"),
    output:
        page=page("cluster.md"),
    log:
        log_file("docs/cluster"),
    benchmark:
        benchmark_file("docs/cluster")
    params:
        **stage("docs.cluster_page"),
        settings=config["sharing"],
    message:
        "The cost of large sweeps"
    script:
        "../../scripts/make.py"


rule companion:
    input:
        [source(f"scripts/docs/companion/{name}") for name in ("page.html", "page.css", "solver.js", "page.js")],
        maps=[table(f"sweeps/{name}") for name in config["companion"]["maps"]],
    output:
        page=page("companion.html"),
    log:
        log_file("docs/companion"),
    benchmark:
        benchmark_file("docs/companion")
    params:
        **stage("docs.companion.build"),
        settings={name: config[name] for name in ("model", "solver", "companion")},
    message:
        "The interactive page"
    script:
        "../../scripts/make.py"


rule findings:
    input:
        **FACTS,
        templates=[source("workflow/templates/findings.md")],
    output:
        result("findings.md"),
    log:
        log_file("docs/findings"),
    benchmark:
        benchmark_file("docs/findings")
    params:
        **stage("docs.pages"),
        **PAGE_PARAMS,
    message:
        "Findings beyond the paper"
    script:
        "../../scripts/make.py"


# The README, the form of the journal ReScience, and the manifest of CODECHECK.
rule top_level_pages:
    input:
        **FACTS,
        templates=[source(f"workflow/templates/{name}") for name in ("README.md", "metadata.yaml", "codecheck.yml")],
        findings=result("findings.md"),
    output:
        [top_level_page(name) for name in ("README.md", "metadata.yaml", "codecheck.yml")],
    log:
        log_file("docs/kept_pages"),
    benchmark:
        benchmark_file("docs/kept_pages")
    params:
        **stage("docs.pages"),
        **PAGE_PARAMS,
    message:
        "README and metadata"
    script:
        "../../scripts/make.py"


rule costs:
    input:
        figure_files(),
        [table(reference) for reference in references_of_claims(config["claims"])],
    output:
        costs=result("costs.json"),
    log:
        log_file("docs/costs"),
    benchmark:
        benchmark_file("docs/costs")
    params:
        **stage("docs.costs"),
        files=files_of_costs(),
        snakefile=os.path.relpath(workflow.main_snakefile),
        configfiles=[os.path.relpath(file) for file in workflow.overwrite_configfiles],
    message:
        "The cost of each figure and claim"
    script:
        "../../scripts/make.py"


rule figure_costs:
    input:
        costs=result("costs.json"),
    output:
        page=page("figures.md"),
    log:
        log_file("docs/figures"),
    benchmark:
        benchmark_file("docs/figures")
    params:
        **stage("docs.figure_costs"),
        figures=list(config["figures"]),
    message:
        "The page of costs"
    script:
        "../../scripts/make.py"


rule article_text:
    input:
        CONFIG_FILES,
        **FACTS,
        **ARTICLE_PARTS,
        templates=[source("workflow/templates/article.md")],
    output:
        result("article/article.md"),
    log:
        log_file("docs/article_text"),
    benchmark:
        benchmark_file("docs/article_text")
    params:
        **stage("docs.pages"),
        **PAGE_PARAMS,
        medium="print",
        folder=os.sep + figure_file("")[: -len(".pdf")],
        written=written_keys,
    message:
        "The text of the article"
    script:
        "../../scripts/make.py"


rule article:
    input:
        figure_files(),
        text=result("article/article.md"),
        frame=source("workflow/templates/article.typ"),
    output:
        article=result("article.pdf"),
    log:
        log_file("docs/article"),
    benchmark:
        benchmark_file("docs/article")
    params:
        **stage("docs.article"),
    message:
        "The article"
    script:
        "../../scripts/make.py"


rule site_pages:
    input:
        CONFIG_FILES,
        **FACTS,
        **ARTICLE_PARTS,
        templates=[source("workflow/templates/article.md"), *sources("workflow/templates/site/*.md")],
    output:
        [result(f"site_pages/{Path(file).name}") for file in ("article.md", *sources("workflow/templates/site/*.md"))],
    log:
        log_file("docs/site_pages"),
    benchmark:
        benchmark_file("docs/site_pages")
    params:
        **stage("docs.pages"),
        **PAGE_PARAMS,
        medium="site",
        folder="figures/",
        written=written_keys,
        known=known_keys,
        library=LIBRARY,
    message:
        "The pages of the site"
    script:
        "../../scripts/make.py"


rule site:
    input:
        article=result("article.pdf"),
        companion=page("companion.html"),
        pages=[*rules.site_pages.output, source("scripts/conveyor/README.md")],
        style=source("scripts/docs/site.css"),
        pdf=figure_files(),
        png=figure_files("png"),
    output:
        directory(result("site")),
    log:
        log_file("docs/site"),
    benchmark:
        benchmark_file("docs/site")
    resources:
        mem_mb=1500,
    params:
        code=source_hash("build_site", *LIBRARY),
    message:
        "The site"
    script:
        "../../scripts/build_site.py"


# The pictures of the README.
rule picture:
    input:
        png=figure_file("{figure}", "png"),
    output:
        picture=page("{figure}.png"),
    log:
        log_file("docs/{figure}"),
    benchmark:
        benchmark_file("docs/{figure}")
    wildcard_constraints:
        figure="overview|work_precision",
    params:
        **stage("docs.pictures"),
    message:
        "The picture {wildcards.figure} of the documentation"
    script:
        "../../scripts/make.py"


# The JSON Schema of the config, which the repository keeps for editors: snakemake --force config/schema.json
rule schema:
    output:
        schema="config/schema.json",
    log:
        log_file("docs/schema"),
    benchmark:
        benchmark_file("docs/schema")
    params:
        **stage("docs.copy_page"),
        page=lambda wildcards: json_schema(),
    message:
        "The JSON Schema of the config"
    script:
        "../../scripts/make.py"
