"""Settings of the stage claims. The claims themselves are no settings: see statements.py."""

from typing_extensions import TypedDict

from conveyor_pipeline.common.settings import Name, described, list_of, number
from conveyor_pipeline.paper.claims.statements import read_claims


class Uncertainty(TypedDict):
    tighter: number("factor of the tighter tolerances", gt=1, le=1e4)
    claims: list_of(Name, "claims that are checked with tighter tolerances", min_length=0)


SECTIONS = {"uncertainty": described(Uncertainty, "check of the claims with tighter tolerances")}

TABLE_SETTINGS = {"results/claims": lambda config: {"claims": read_claims()}}
