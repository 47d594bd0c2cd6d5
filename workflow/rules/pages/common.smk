# Functions about the pages that state facts of all floors.
from conveyor_pipeline.config.stages import FLOORS

# README, article and site state facts of these floors.
MISSING_FLOORS = {"paper", "machine", "study"} - {*FLOORS}


def check_floors(target):
    """An error for a target about all floors, if this copy lacks one."""
    if MISSING_FLOORS:
        raise WorkflowError(f"{target} need all floors, but this copy lacks {' and '.join(sorted(MISSING_FLOORS))}")


def inputs_of_page(wildcards):
    """The inputs that fill the template of a page; an error for a missing floor."""
    if wildcards.page == "checked":
        check_floors("the tables of docs/checked.md")
    return PAGES[wildcards.page]


def tables_of_facts(wildcards):
    """The tables behind the text of README, article and site; an error for another conveyor or a missing floor."""
    check_paper("the text of README, article and site")
    check_floors("README, article and site")
    return FACTS
