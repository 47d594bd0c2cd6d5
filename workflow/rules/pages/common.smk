# Functions about the pages that state facts of all floors.
from conveyor_pipeline.config.stages import FLOORS

# README, article and site state facts of these floors.
MISSING_FLOORS = {"paper", "machine", "study"} - {*FLOORS}


def tables_of_facts(wildcards):
    """The tables behind the text of README, article and site; an error for another conveyor or a missing floor."""
    check_paper("the text of README, article and site")
    if MISSING_FLOORS:
        raise WorkflowError(
            f"README, article and site need all floors, but this copy lacks {' and '.join(sorted(MISSING_FLOORS))}"
        )
    return FACTS
