"""Settings of the stage claims: the claims, with units and ranges."""

from typing import NotRequired

from typing_extensions import TypedDict

from conveyor_pipeline.common.settings import (
    Acceleration,
    Line,
    Reference,
    described,
    entries,
    interval,
    many,
    mapping,
    number,
    text,
    word,
)

CLAIMS = tuple(f"C{place:02d}" for place in range(1, 27))
NameOfClaim = word("claim of the paper", *CLAIMS)
Statistic = number("number", ge=-1e300, le=1e300)
Interval = interval(Statistic | None, "[least, largest] number, or null for no bound", point=True)
Quantity = TypedDict(
    "Quantity",
    {
        "is": described(Line, "quantity and unit"),
        "paper": described(Statistic | None, "the paper's number, or null"),
        "accepted": Interval,
        "because": text("reason for the interval", r"[\s\S]{3,}", "a reason of at least three letters"),
    },
)


FINDING_SETTINGS = {
    "acceleration": Acceleration,
    "velocities_of": mapping(
        "accepted velocities of both states in cm/s", {"lower_end": Interval, "upper_end": Interval, "fall": Interval}
    ),
}


class Claim(TypedDict):
    where: described(Line, "section or figure of the paper")
    statement: described(Line, "the claim")
    finding: described(Line, "function of scripts/conveyor_pipeline/FLOOR/claims, as MODULE.FUNCTION")
    settings: NotRequired[mapping("settings of the finding", FINDING_SETTINGS, total=False)]
    quantities: entries(Quantity, "quantities that the finding returns", min_length=1)
    tables: entries(Reference, "tables by the roles that the finding knows")


class Uncertainty(TypedDict):
    tighter: number("factor of the tighter tolerances", gt=1, le=1e4)
    claims: many(NameOfClaim, "claims that are checked with tighter tolerances", least=0)


SECTIONS = {
    "claims": described(dict[NameOfClaim, Claim], "claims of the paper"),
    "uncertainty": described(Uncertainty, "check of the claims with tighter tolerances"),
}


# The tables that are not entries, and the function that returns the settings of each. Floors add claims, so they are
# sorted.
TABLE_SETTINGS = {"results/claims": lambda config: {"claims": dict(sorted(config["claims"].items()))}}
