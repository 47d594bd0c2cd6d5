"""One of the paper's statements, checked alone, so that only its own tables are needed."""

import pandas as pd

from conveyor_pipeline.paper.claims import verdicts


def make(settings: dict, references: list[str], template: str, read: list[pd.DataFrame]) -> str:
    """The report on a statement, from its tables, which `references` name as SECTION/NAME."""
    return verdicts.make(settings, references, template, read)["report"]
