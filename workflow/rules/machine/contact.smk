# The contact from materials and from a drop, and what its uncertainty changes in the advice. The target `machine` has the page if
# the config has a section `contact` of its own.
CONTACT_FILES = [result("contact.md")] if loaded.stated.get("contact") else []


rule contact:
    """Transit at the advised amplitudes on softer and stiffer contacts, and on such that bounce less and more."""
    input:
        **tables_of("operating/advice"),
    output:
        **tables_of("contact/variants"),
    log:
        log_file("contact/variants"),
    benchmark:
        benchmark_file("contact/variants")
    threads: THREADS
    params:
        **stage("conveyor_pipeline.machine.contact.variants", "contact/variants"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"


rule contact_page:
    """The contact in words."""
    input:
        **tables_of("contact/variants", "operating/advice"),
        template=source("workflow/rules/machine/contact.md"),
    output:
        page=result("contact.md"),
    log:
        log_file("contact/page"),
    params:
        **stage("conveyor_pipeline.machine.contact.page"),
    script:
        "../../../scripts/conveyor_pipeline/make.py"
