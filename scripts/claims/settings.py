"""Settings of the stage claims: the claims, with units and ranges."""

from typing import Annotated, NotRequired

from pydantic import Field
from typing_extensions import TypedDict

from ..pipeline.settings import Acceleration, Line, Name, Reference, interval, many, mapping, number, text, word

Statistic = number("number", ge=-1e300, le=1e300)
Quantity = TypedDict(
    "Quantity",
    {
        "is": Annotated[Line, Field(description="quantity and unit")],
        "paper": Annotated[Statistic | None, Field(description="the paper's number, or null")],
        "accepted": interval(Statistic | None, "[least, largest] number, or null for no bound", point=True),
        "because": text("reason for the interval", r"[\s\S]{3,}", "a reason of at least three letters"),
    },
)


class Claim(TypedDict):
    where: Annotated[Line, Field(description="section or figure of the paper")]
    statement: Annotated[Line, Field(description="the claim")]
    finding: Annotated[Line, Field(description="function of scripts/claims, as MODULE.FUNCTION")]
    settings: NotRequired[mapping("settings of the finding", {"acceleration": Acceleration}, total=False)]
    quantities: Annotated[dict[Name, Quantity], Field(description="quantities that the finding returns", min_length=1)]
    tables: Annotated[dict[Name, Reference], Field(description="tables by the roles that the finding knows")]


CLAIMS = tuple(f"C{place:02d}" for place in range(1, 25))
NameOfClaim = word("claim of the paper", *CLAIMS)


class Uncertainty(TypedDict):
    tighter: number("factor of the tighter tolerances", gt=1, le=1e4)
    claims: many(NameOfClaim, "claims that are checked with tighter tolerances", least=0)


SECTIONS = {
    "claims": Annotated[dict[NameOfClaim, Claim], Field(description="claims of the paper")],
    "uncertainty": Annotated[Uncertainty, Field(description="check of the claims with tighter tolerances")],
}

# The tables that are not entries, and the function that returns the settings of each.
TABLE_SETTINGS = {"results/claims": lambda config: {"claims": config["claims"]}}
