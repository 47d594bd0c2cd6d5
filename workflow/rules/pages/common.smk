# Functions about the pages that state facts of all floors.
from conveyor_pipeline.config.stages import FLOORS

# README, article and site state facts of these floors.
MISSING_FLOORS = {"paper", "machine", "study"} - {*FLOORS}


def check_all_floors():
    """An error for a page about the paper's conveyor and all floors, if the config or this copy has others."""
    check_paper("the text of README, article and site")
    if MISSING_FLOORS:
        raise WorkflowError(
            f"README, article, site and docs/checked.md need all floors, but this copy lacks {' and '.join(sorted(MISSING_FLOORS))}"
        )


def inputs_of_page(wildcards):
    """The inputs that fill the template of a page."""
    if wildcards.page == "checked":
        check_all_floors()
    return PAGES[wildcards.page]


def tables_of_facts(wildcards):
    """The tables behind the text of README, article and site."""
    check_all_floors()
    return FACTS
