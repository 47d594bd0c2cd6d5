"""The config: the sections of all stages, which the module settings.py of each stage declares, and what they share."""

from pydantic import ConfigDict, TypeAdapter
from typing_extensions import TypedDict

from conveyor_pipeline.common.settings import (
    LONGEST_NAME,
    MODEL_KEYS,
    NAME,
    Duration,
    Method,
    Step,
    Tolerance,
    described,
    mapping,
    text,
    whole,
)
from conveyor_pipeline.config.stages import declared


class Solver(TypedDict):
    duration: Duration
    method: Method
    tolerance: Tolerance
    step: Step
    settling: whole(
        "limit of the search for a period; longer motions are chaos or undecided", 256, 10**9, "excitation cycles"
    )


class Sharing(TypedDict):
    rows: whole("largest number of rows of a sweep that one job computes", 1, 10**9)


Config = TypedDict(
    "Config",
    {
        "prefix": text(
            "folder below results/ and figures/ for the results of this config",
            f"(|{NAME})",
            f"a folder name of at most {LONGEST_NAME} letters, digits, - and _, or nothing",
        ),
        "model": mapping("the conveyor and the part", MODEL_KEYS),
        "solver": described(Solver, "default settings of all trajectories"),
        "sharing": described(Sharing, "division of sweeps into jobs"),
        **declared("SECTIONS"),
    },
)
Config.__pydantic_config__ = ConfigDict(extra="forbid", allow_inf_nan=False)
MODEL = TypeAdapter(Config)


def is_same_model(one: dict, other: dict) -> bool:
    """Whether two sections `model` describe the same: a default that is written out changes nothing."""
    filled = [{"static_friction": model["friction"], "harmonics": []} | model for model in (one, other)]
    return filled[0] == filled[1]
