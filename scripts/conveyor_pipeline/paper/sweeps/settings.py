"""Settings of the stage sweeps: sweeps, with units and ranges."""

from typing import NotRequired

from conveyor_pipeline.common.settings import Followed, entries, word


class Sweep(Followed):
    needs: NotRequired[word("vertical leaves out the feeding velocity, which is faster", "feeding", "vertical")]


SECTIONS = {"sweeps": entries(Sweep, "trajectories for all combinations of axes")}
