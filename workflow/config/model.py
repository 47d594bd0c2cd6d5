"""The config: the sections of all stages, which scripts/STAGE/settings.py declares, and what they share."""

from typing import Annotated, NotRequired

from pydantic import ConfigDict, Field, TypeAdapter
from typing_extensions import TypedDict

from scripts.accuracy import settings as accuracy
from scripts.calibration.measurements import CALIBRATED
from scripts.claims import settings as claims
from scripts.conveyor import DESCRIPTIONS
from scripts.dimensions import settings as dimensions
from scripts.docs import settings as docs
from scripts.excitation import settings as excitation
from scripts.figures import settings as figures
from scripts.fit import settings as fit
from scripts.identification.settings import NUMBERS_OF_CLAIMS
from scripts.motion import settings as motion
from scripts.operating import settings as operating
from scripts.orbits import settings as orbits
from scripts.pipeline.settings import (
    LONGEST_NAME,
    MODEL_KEYS,
    MODEL_TYPES,
    NAME,
    Acceleration,
    Duration,
    HeightNumber,
    Line,
    Method,
    Seed,
    Step,
    Tolerance,
    check_ascending,
    interval,
    many,
    mapping,
    number,
    span,
    text,
    whole,
    word,
)
from scripts.sensitivity import settings as sensitivity
from scripts.sweeps import settings as sweeps

Seconds = number("measured time on one core", "s", gt=0, le=1e6)
SecondsPair = interval(Seconds, "[time where the plate cannot throw parts, time where it can]", point=True)
Megabytes = number("memory", "MB", gt=0, le=1e6)


class Solver(TypedDict):
    duration: Duration
    method: Method
    tolerance: Tolerance
    step: Step
    settling: whole("an initial condition that has not settled by then may be chaotic", 256, 10**9, "excitation cycles")
    mean_settling: whole(
        "mean search of many initial conditions; longer searches end undecided", 64, 10**9, "excitation cycles"
    )


class Costs(TypedDict):
    cycle: number("time per excitation cycle by the method event, on one core", "s", gt=0, le=1e6)
    fixed_step: number("time per step of a fixed-step method, on one core", "s", gt=0, le=1e6)
    start: mapping(
        "cost per initial condition, by what is known of its conveyor",
        {"alone": SecondsPair, "chaos": SecondsPair, "orbits": SecondsPair},
    )
    conveyor: mapping("cost of the search for attractors, per conveyor", {"chaos": SecondsPair, "orbits": SecondsPair})


class Sharing(TypedDict):
    job_seconds: number("duration of a job on two cores", "s", gt=0, le=1e6)
    most_jobs: whole("largest number of jobs per sweep", 1, 10**5)
    core_hours: number("largest estimated cost of a sweep", "h", gt=0, le=1e9)
    seconds: Annotated[Costs, Field(description="measured costs from which a sweep's cost is estimated")]
    megabytes: mapping(
        "memory of a job and of each row", {"program": Megabytes, "row": Megabytes, "written_row": Megabytes}
    )


POSITIVE_GROUPS = ("friction", "damping", "stiffness", "exponent")
RANGES_OF_CALIBRATION = {
    name: interval(
        number(name, "1", gt=0) if name in POSITIVE_GROUPS else MODEL_TYPES[name],
        f"searched range of {DESCRIPTIONS[name]}",
    )
    for name in CALIBRATED
}


class Calibration(TypedDict):
    measurements: NotRequired[
        Annotated[Line, Field(description="CSV file of measured velocities, relative to this overlay")]
    ]
    parameters: many(word("parameter that is searched", *CALIBRATED), "parameters that are searched")
    alternatives: mapping(
        "largest difference from the stated value that is searched in addition",
        {
            "inclination": number(DESCRIPTIONS["inclination"], "rad", gt=0, le=0.5),
            "phase_shift": number(DESCRIPTIONS["phase_shift"], "rad", gt=0, le=3.15),
        },
    )
    decisive: number("Bayes factor from which an alternative rejects the model", gt=1)
    ranges: mapping("range of each parameter, in dimensionless groups", RANGES_OF_CALIBRATION)
    noise: number("relative standard deviation of a velocity without its own", ge=0, lt=1)
    outliers: number("share of measurements that may have any velocity", gt=0, lt=1)
    parts: whole("random initial conditions per set of parameters and amplitude", 8, 10**4)
    first: whole("sets of parameters of the first round of the search", 32, 10**5)
    points: whole("sets of parameters of each further round", 32, 10**5)
    rounds: whole("further rounds at most", 1, 1000)
    enough: number("effective number of samples at which the search ends", ge=1, le=1e6)
    effective: number("least effective number of samples for intervals", ge=1, le=1e6)
    confidence: number("confidence level of the intervals", gt=0, lt=1)
    samples: whole("samples of the posterior in the table", 10, 10**5)
    checked: whole("samples of the posterior that are tested against the measurements", 1, 10**4)
    checked_parts: whole("random initial conditions of such a test", 8, 10**4)
    replicates: whole("replicates of the measurements of such a test", 100, 10**6)
    significance: number("p-value below which the model does not explain the measurements", gt=0, lt=1)
    amplitudes: whole("amplitudes at which velocities are predicted", 2, 1000)
    beyond: number("relative distance beyond the measured amplitudes, for the next measurement", ge=0, lt=1)
    predicted: whole("samples of the posterior from which velocities are predicted", 10, 10**4)
    predicted_parts: whole("random initial conditions for each of them", 8, 10**4)
    seed: Seed


STUDY_CONVEYORS = {name: MODEL_TYPES[name] for name in ("frequency", "angle", "mass", "friction")} | {
    name: number(f"dimensionless group of the {name}", "1", gt=0) for name in ("damping", "stiffness")
}
Sets = whole("data sets", 0, 10**6)


class MeasuredExample(TypedDict):
    model: mapping("the conveyor and the part", {name: MODEL_TYPES[name] for name in (*STUDY_CONVEYORS,)})
    acceleration: interval(Acceleration, "lowest and highest amplitude")
    amplitudes: whole("number of amplitudes", 2, 1000)
    parts: whole("parts at each amplitude", 1, 1000)
    noise: number("relative standard deviation of a velocity", ge=0, lt=1)
    seed: Seed


class CalibrationStudy(TypedDict):
    sets: mapping(
        "number of data sets of each kind",
        dict.fromkeys(("rich", "poor", "phase_shift", "inclination", "effective_value", "exponent"), Sets),
    )
    conveyors: mapping(
        "ranges of the random conveyors", {name: interval(item, name) for name, item in STUDY_CONVEYORS.items()}
    )
    throw_number: interval(number("throw number a_z/g", gt=0, le=100), "lowest and highest amplitude")
    amplitudes: whole("amplitudes of a rich set", 2, 1000)
    parts_of_study: whole("parts at each amplitude of a rich set", 1, 1000)
    poor: whole("velocities of a poor set", 3, 1000)
    duration: number("time over which a velocity is measured, and before", gt=0, le=1e4)
    band: mapping(
        "settings of the predicted band",
        {name: Calibration.__annotations__[name] for name in ("amplitudes", "beyond", "predicted")},
    )
    held_out: whole("further velocities to check the predicted band", 1, 10**5)
    wrong: mapping(
        "differences that the calibration is not told",
        {name: MODEL_TYPES[name] for name in ("phase_shift", "inclination", "exponent")},
    )
    seed: Seed
    example: Annotated[MeasuredExample, Field(description="synthetic measurements of the example")]


NumberOfClaim = word("quantity of a claim, as CLAIM.QUANTITY", *NUMBERS_OF_CLAIMS)


class Searched(TypedDict):
    friction: interval(number("friction", "1", gt=0, le=10), DESCRIPTIONS["friction"])
    loss: interval(number("loss", "1", gt=0, le=2), "group L of the contact: damping × contact time / mass")
    group: interval(number("group", "1", gt=0, le=1e12), "group K of the contact: dimensionless stiffness")
    angle: interval(number("angle", "rad", gt=0, le=1.5707), DESCRIPTIONS["angle"])


class Evidence(TypedDict):
    """Numbers that the search fits."""

    without: many(NumberOfClaim, "quantities that are left out", least=0)
    shifted: Annotated[bool, Field(description="add the error of the paper's method at its parameters")]


class Edges(TypedDict):
    vertical_acceleration: span(number("vertical amplitude", "m/s²", gt=0, le=1e4), "scan from below")
    further: number("distance above an edge at which the first state is searched for", "m/s²", gt=0, le=1e3)
    resolution: number("accuracy of an edge", "m/s²", gt=0, le=10)


class PosteriorSearch(TypedDict):
    points: whole("points of each round", 50, 10**6)
    rounds: whole("rounds after the first one", 1, 100)
    followed: whole("conveyors whose velocities are computed", 50, 10**6)
    seed: Seed
    confidence: number("confidence level of the intervals", gt=0, lt=1)


class Identification(TypedDict):
    bounds: Annotated[Searched, Field(description="search interval of each parameter")]
    evidence: mapping("sets of evidence", dict.fromkeys(("all", "end_left_out", "paper_method"), Evidence))
    contacts: mapping(
        "contacts in the table of edges", dict.fromkeys(("loss", "group"), whole("number of values", 4, 1000))
    )
    heights: many(HeightNumber, "initial heights in the table of edges", least=4, check=check_ascending)
    edges: Annotated[Edges, Field(description="edges of the states of motion")]
    inside: number("distance inside the interval of two states at which velocities are measured", "m/s²", gt=0, le=10)
    search: Annotated[PosteriorSearch, Field(description="importance sampling of the parameters")]


Config = TypedDict(
    "Config",
    {
        "prefix": text(
            "folder below results/ and figures/ for the results of this config",
            f"(|{NAME})",
            f"a folder name of at most {LONGEST_NAME} letters, digits, - and _, or nothing",
        ),
        "model": mapping("the conveyor and the part", MODEL_KEYS),
        "solver": Annotated[Solver, Field(description="default settings of all trajectories")],
        "sharing": Annotated[Sharing, Field(description="division of sweeps into jobs")],
        **sweeps.SECTIONS,
        **motion.SECTIONS,
        **fit.SECTIONS,
        **dimensions.SECTIONS,
        **orbits.SECTIONS,
        **claims.SECTIONS,
        **accuracy.SECTIONS,
        **sensitivity.SECTIONS,
        **operating.SECTIONS,
        **excitation.SECTIONS,
        "calibration": Annotated[Calibration, Field(description="parameters from measured velocities")],
        "calibration_study": Annotated[CalibrationStudy, Field(description="simulation study of the calibration")],
        "identification": Annotated[Identification, Field(description="parameters that the paper's numbers imply")],
        **figures.SECTIONS,
        **docs.SECTIONS,
    },
)
Config.__pydantic_config__ = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)
MODEL = TypeAdapter(Config)
