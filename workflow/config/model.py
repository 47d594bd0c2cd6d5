"""The config: the sections of all stages, which scripts/STAGE/settings.py declares, and what they share."""

from pydantic import ConfigDict, TypeAdapter
from typing_extensions import TypedDict

from scripts.pipeline.settings import (
    LONGEST_NAME,
    MODEL_KEYS,
    NAME,
    Duration,
    Method,
    Step,
    Tolerance,
    described,
    mapping,
    number,
    text,
    whole,
)

from .stages import declared


class Solver(TypedDict):
    duration: Duration
    method: Method
    tolerance: Tolerance
    step: Step
    settling: whole("an initial condition that has not settled by then may be chaotic", 256, 10**9, "excitation cycles")
    mean_settling: whole(
        "mean search of many initial conditions; longer searches end undecided", 64, 10**9, "excitation cycles"
    )


class Sharing(TypedDict):
    job_seconds: number("duration of a job on two cores", "s", scaled=False, gt=0, le=1e6)
    core_hours: number("largest estimated cost of a sweep", "h", gt=0, le=1e9)


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
