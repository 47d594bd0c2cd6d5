"""Settings of the stage figures: figures, with units and ranges."""

from typing import Annotated, NotRequired

from pydantic import AfterValidator, Strict
from typing_extensions import TypedDict

from conveyor_pipeline.common.settings import (
    Acceleration,
    HeightNumber,
    Line,
    Period,
    Reference,
    described,
    entries,
    interval,
    number,
    word,
)

# [amplitude, initial height]
Portrait = Annotated[tuple[Acceleration, HeightNumber], Strict(False), AfterValidator(list)]


class FigureSettings(TypedDict, total=False):
    acceleration: Acceleration
    z0: HeightNumber
    portraits: described(list[Portrait], "three phase portraits", min_length=3, max_length=3)
    longest_period: Period


class Marks(TypedDict, total=False):
    critical_acceleration: Acceleration
    critical_height: HeightNumber
    two_states: interval(Acceleration, "interval with two states of motion")
    first_positive: Acceleration
    paper_error: number("error of the paper's fit", "m²", gt=0, le=1)
    paper_fit: described(bool, "draw Eq. 13 with the paper's coefficients")


class Figure(TypedDict):
    section: described(Line, "section of the paper")
    needs: word("motion that the figure needs", "feeding", "vertical", "nothing")
    tables: entries(Reference, "tables by the roles that the plot script knows")
    settings: NotRequired[described(FigureSettings, "numbers that the plot script draws")]
    marks: NotRequired[described(Marks, "numbers of the paper, drawn if the model is the paper's")]
    caption_tables: NotRequired[entries(Reference, "further tables of the caption")]


SECTIONS = {
    "figures": entries(Figure, "figures"),
    "figures_on_request": entries(Figure, "figures that only an explicit target makes"),
}
