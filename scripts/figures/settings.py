"""Settings of the stage figures: figures, with units and ranges."""

from typing import Annotated, NotRequired

from pydantic import AfterValidator, Field, Strict
from typing_extensions import TypedDict

from ..pipeline.settings import Acceleration, HeightNumber, Line, Name, Period, Reference, interval, number, word

# [amplitude, initial height]
Portrait = Annotated[tuple[Acceleration, HeightNumber], Strict(False), AfterValidator(list)]


class FigureSettings(TypedDict, total=False):
    acceleration: Acceleration
    z0: HeightNumber
    critical_acceleration: Acceleration
    critical_height: HeightNumber
    two_states: interval(Acceleration, "interval with two states of motion")
    first_positive: Acceleration
    portraits: Annotated[list[Portrait], Field(min_length=3, max_length=3, description="three phase portraits")]
    longest_period: Period
    paper_error: number("error of the paper's fit", "m²", gt=0, le=1)


class Figure(TypedDict):
    section: Annotated[Line, Field(description="section of the paper")]
    paper_only: NotRequired[Annotated[Line, Field(description="why only the paper's conveyor has this figure")]]
    needs: word("motion that the figure needs", "feeding", "vertical", "nothing")
    tables: Annotated[dict[Name, Reference], Field(description="tables by the roles that the plot script knows")]
    settings: NotRequired[Annotated[FigureSettings, Field(description="numbers that the plot script draws")]]
    caption_tables: NotRequired[Annotated[dict[Name, Reference], Field(description="further tables of the caption")]]


SECTIONS = {
    "figures": Annotated[dict[Name, Figure], Field(description="figures")],
    "figures_on_request": Annotated[
        dict[Name, Figure], Field(description="figures that only an explicit target makes")
    ],
}
