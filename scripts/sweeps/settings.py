"""Settings of the stage sweeps: sweeps, with units and ranges."""

from typing import Annotated, NotRequired

from pydantic import Field

from ..pipeline.settings import Duration, Followed, Name, word


class Sweep(Followed):
    duration: NotRequired[Duration]
    needs: NotRequired[word("vertical leaves out the feeding velocity, which is faster", "feeding", "vertical")]


SECTIONS = {
    "sweeps": Annotated[dict[Name, Sweep], Field(description="trajectories for all combinations of axes")],
}
