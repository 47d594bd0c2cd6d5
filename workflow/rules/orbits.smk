# Periodic orbits, attractors over the amplitude, their exponents, and whether they are chaotic.


def of_sections(*sections):
    """A param: these sections of the config with the model and the tolerance, overrides included, later ones first."""
    merged = {"tolerance": config["solver"]["tolerance"]}
    if "attractors" in sections:
        merged["settling"] = config["solver"]["settling"]
    for section in sections:
        merged.update(config[section])
    return {**merged, "model": {**config["model"], **merged.get("model", {})}}


rule orbits:
    output:
        branches=table("orbits", "branches"),
        folds_and_doublings=table("orbits", "folds_and_doublings"),
        cascade=table("orbits", "cascade"),
    log:
        log_file("orbits", "orbits"),
    benchmark:
        benchmark_file("orbits", "orbits")
    threads: 1
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        settings=of_sections("orbits"),
        code=source_hash("orbits"),
    message:
        "Periodic orbits"
    script:
        "../../scripts/orbits.py"


# Wall times differ from run to run and have a table of their own; the others have equal bytes every time.
rule certificates:
    input:
        branches=table("orbits", "branches"),
        folds_and_doublings=table("orbits", "folds_and_doublings"),
        cascade=table("orbits", "cascade"),
    output:
        certificates=table("orbits", "certificates"),
        certified_bifurcations=table("orbits", "certified_bifurcations"),
        certified_chaos=table("orbits", "certified_chaos"),
        times=table("orbits", "certificate_times"),
    log:
        log_file("orbits", "certificates"),
    benchmark:
        benchmark_file("orbits", "certificates")
    threads: 2
    resources:
        mem_mb=1500,
        runtime=60,
    params:
        settings={**config["certificates"], "model": of_sections("orbits")["model"]},
        code=source_hash("certificates"),
    message:
        "Orbits, bifurcations and chaos, proved"
    script:
        "../../scripts/certificates.py"


rule certificates_page:
    input:
        certificates=table("orbits", "certificates"),
        certified_bifurcations=table("orbits", "certified_bifurcations"),
        certified_chaos=table("orbits", "certified_chaos"),
    output:
        "docs/certificates.md" if not PREFIX else result("certificates.md"),
    log:
        log_file("docs", "certificates"),
    localrule: True
    params:
        code=source_hash("certificates_page"),
    message:
        "What is proved, in words"
    script:
        "../../scripts/certificates_page.py"


rule attractors:
    output:
        table("attractors", "strobes"),
    log:
        log_file("attractors", "strobes"),
    benchmark:
        benchmark_file("attractors", "strobes")
    threads: 2
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        settings=of_sections("attractors"),
        code=source_hash("attractors"),
    message:
        "Attractors over the amplitude"
    script:
        "../../scripts/attractors.py"


rule lyapunov:
    input:
        table("attractors", "strobes"),
    output:
        table("lyapunov", "spectrum"),
    log:
        log_file("lyapunov", "spectrum"),
    benchmark:
        benchmark_file("lyapunov", "spectrum")
    threads: 2
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        settings=of_sections("attractors", "lyapunov"),
        code=source_hash("lyapunov"),
    message:
        "Lyapunov exponents over the amplitude"
    script:
        "../../scripts/lyapunov.py"


rule witnesses:
    input:
        strobes=table("attractors", "strobes"),
        spectrum=table("lyapunov", "spectrum"),
    output:
        table("lyapunov", "witnesses"),
    log:
        log_file("lyapunov", "witnesses"),
    benchmark:
        benchmark_file("lyapunov", "witnesses")
    threads: 2
    resources:
        mem_mb=1000,
        runtime=30,
    params:
        settings=of_sections("attractors", "witnesses"),
        code=source_hash("witnesses"),
    message:
        "Chaotic or not, by three witnesses"
    script:
        "../../scripts/witnesses.py"
