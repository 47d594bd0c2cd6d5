"""All keys of the config in their canonical order, with description, unit and range."""

from typing import Annotated, Literal, NotRequired

from pydantic import AfterValidator, ConfigDict, Field, Strict, TypeAdapter
from typing_extensions import TypedDict

from scripts.calibration.measurements import CALIBRATED
from scripts.conveyor import DESCRIPTIONS, FIXED_STEP_METHODS, UNITS
from scripts.identification.settings import NUMBERS_OF_CLAIMS

from .types import (
    AXIS_TYPES,
    LONGEST_NAME,
    MODEL_KEYS,
    MODEL_TYPES,
    MOST_POINTS,
    NAME,
    Axes,
    Line,
    Model,
    Name,
    Reference,
    axis,
    check_ascending,
    check_span,
    interval,
    many,
    mapping,
    number,
    parameter,
    span,
    text,
    whole,
    word,
)

# Types of several keys.
Acceleration, Accelerations = MODEL_TYPES["acceleration"], AXIS_TYPES["acceleration"]
Height, HeightNumber = MODEL_TYPES["z0"], parameter("z0", "height above the mean position of the plate")
Velocity = parameter("vz0")
Duration = number("simulated time of a run", "s", gt=0, le=1e6)
Durations = many(Duration, "durations")
FixedStepMethod = word("method with a fixed step", *FIXED_STEP_METHODS)
Method = word("event, or a method with a fixed step", "event", *FIXED_STEP_METHODS)
Tolerance = number("relative error per step of the method event", ge=1e-14, le=1e-2)
Tolerances = many(Tolerance, "relative tolerances")
Step = number("time step of the fixed-step methods", "s", ge=1e-12, le=1e-1)
Steps = many(Step, "time steps of the fixed-step methods")
Epsilon = number("size of the perturbation, in units of the perturbed parameter", ge=1e-15, le=1)
Seed = whole("seed of the random numbers", 0, 2**32 - 1)
Cycles = whole("length of a run", 256, 10**9, "excitation cycles")
ManySamples = many(whole("number of samples", 100, 10**8), "numbers of samples")
Period = whole("longest period considered", 1, 64, "excitation cycles")
Repeats = whole("repetitions", 1, 10**9)
MaxEvaluations = whole("force evaluations after which a peer method is stopped", 1, 10**9)
Seconds = number("measured time on one core", "s", gt=0, le=1e6)
SecondsPair = interval(Seconds, "[time where the plate cannot throw parts, time where it can]", point=True)
Megabytes = number("memory", "MB", gt=0, le=1e6)
Bits = whole("bits of the interval arithmetic", 53, 4096)
Order = whole("order of the Taylor series", 4, 200)
LastTerms = number("size of the last terms of the Taylor series, in g/ω² and g/ω", gt=0, le=1e-3)
Resolution = number("width to which a bracket is halved", "m/s²", gt=0, le=1e4)


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


class Followed(TypedDict):
    """Keys of a table of trajectories."""

    axes: Axes
    model: NotRequired[Model]
    method: NotRequired[Method]
    methods: NotRequired[
        many(Method, "methods; the first one makes the table NAME, each further one a table NAME_METHOD")
    ]
    tolerance: NotRequired[Tolerance]
    step: NotRequired[Step]


class Sweep(Followed):
    duration: NotRequired[Duration]
    needs: NotRequired[word("vertical leaves out the feeding velocity, which is faster", "feeding", "vertical")]


class Estimate(Followed):
    duration: NotRequired[Duration]
    perturb: word("perturbed parameter", "psi0", "z0", "vz0")
    epsilon: Epsilon
    output: word("compared state variable", "x", "vx", "z", "vz")
    last: number("share of the run that is averaged", "of the duration", gt=0, lt=1)
    samples: whole("samples in this share", 2, 10**8)


class Critical(Followed):
    duration: NotRequired[Duration]
    scan: axis(HeightNumber, "initial heights that are scanned for changes", least=2, check=check_ascending)
    resolution: number("accuracy of a critical height", "m", ge=1e-15, le=1)


FIT = {
    "A": number("parameter A of Eq. 13", "m²/s²", ge=-1e6, le=1e6),
    "B": number("parameter B of Eq. 13", "m/s²", ge=-1e6, le=1e6),
    "C": number("parameter C of Eq. 13", "m", ge=-1e6, le=1e6),
}


class Regression(TypedDict):
    critical: Annotated[Name, Field(description="entry of `critical` that Eq. 13 is fitted to")]
    acceleration: NotRequired[interval(Acceleration, "amplitudes of the fitted data")]
    bounds: mapping("search intervals", {name: interval(item, f"bounds of {name}") for name, item in FIT.items()})
    seed: Seed
    evaluations: whole("largest number of evaluations", 1, 10**9)
    valley: span(FIT["B"], "values of B along the valley")
    paper: NotRequired[mapping("the paper's parameters", FIT)]


class Dimension(Followed):
    begin: number("time of the first sample", "s", ge=0, le=1e6)
    interval: number("time between samples", "excitation cycles", gt=0, le=1e3)
    samples: whole("number of samples", 8, 10**8)
    estimator: word("estimator of the dimension", "paper", "box", "correlation")
    octaves: NotRequired[whole("box sizes are 1/2 to 1/2^octaves of the extent", 3, 30)]
    theiler: NotRequired[whole("pairs of samples at most this far apart in time are left out", 0, 10**8, "samples")]
    largest_error: NotRequired[number("estimates with a larger error are left out", gt=0, le=2)]


class Signal(Followed):
    duration: NotRequired[Duration]
    times: span(number("time", "s", ge=0, le=1e6), "times of the samples")


class Spectrum(Followed):
    duration: NotRequired[Duration]
    last: number("share of the run that is transformed", "of the duration", gt=0, le=1)
    samples_per_cycle: whole("samples per excitation cycle", 8, 10**6)


class Impacts(TypedDict):
    axes: Axes
    model: NotRequired[Model]


class SeedOrbit(TypedDict):
    acceleration: Acceleration
    z0: Height
    vz0: NotRequired[Velocity]


class Orbits(TypedDict):
    seeds: NotRequired[
        Annotated[
            list[SeedOrbit], Field(min_length=1, max_length=1000, description="initial conditions of the first orbits")
        ]
    ]
    limits: interval(Acceleration, "amplitudes between which branches are followed")
    max_period: whole("longest period that is followed", 1, 64, "excitation cycles")
    cycles: whole("cycles until a seed is near its orbit", 64, 10**9, "excitation cycles")
    most: whole("orbits after which no further branch is followed", 1, 10**9)
    model: NotRequired[Model]


class CertifiedChaos(TypedDict):
    acceleration: many(Acceleration, "amplitudes of the proofs of chaos", least=0)
    size: number("largest half axis of a parallelogram along the unstable direction, in g/ω² and g/ω", gt=0, le=1)
    ratio: number("unstable half axis over stable half axis", gt=0, le=100)
    longest: whole("longest excursion searched for", 2, 64, "excitation cycles")
    bits: Bits
    order: Order
    tolerance: LastTerms


class Certificates(TypedDict):
    acceleration: Accelerations
    also: many(Acceleration, "further amplitudes", least=0)
    longest_period: Period
    doubled_limit: Acceleration
    bits: Bits
    order: Order
    tolerance: LastTerms
    closeness: number("largest distance of a proved orbit from the stored one, in g/ω² and g/ω", gt=0, le=1)
    doublings: whole("period doublings that are proved", 0, 8)
    half_width: number("half width of the bracket of a doubling", "m/s²", gt=0, le=1e-2)
    half_arc: number("half the arc of a branch around its fold, in g/ω², g/ω and g", gt=0, le=1e-2)
    chaos: Annotated[CertifiedChaos, Field(description="proofs of chaos")]


class Attractors(TypedDict):
    acceleration: Accelerations
    transient: whole("excitation cycles before recording", 0, 10**9, "excitation cycles")
    strobes: whole("stroboscopic samples, one per excitation cycle", 1, 10**9)
    model: NotRequired[Model]
    tolerance: NotRequired[Tolerance]


class Lyapunov(TypedDict):
    cycles: whole("cycles per block", 1, 10**9, "excitation cycles")
    blocks: whole("number of blocks", 2, 10**6)
    tolerance: NotRequired[Tolerance]


class Witnesses(TypedDict):
    strobes: whole("samples of the 0-1 test", 100, 10**8)
    seed: Seed
    significant: number("standard errors by which an exponent is positive", ge=0, le=1e6)
    tolerance: NotRequired[Tolerance]


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


class Goals(TypedDict):
    error: number("relative error of the mean velocity", gt=0, le=1e300)
    speed: number("goal of the speed, in units of explicit Euler's speed", gt=0, le=1e300)
    aim: number("ambition beyond this goal, in the same units", gt=0, le=1e300)


class Case(TypedDict):
    motion: Annotated[Line, Field(description="state of motion")]
    model: Model
    duration: NotRequired[Duration]
    loosest: NotRequired[Tolerance]
    step: NotRequired[Step]
    compared: number("time over which the error is measured", "s", gt=0, le=1e6)
    wanted: Annotated[Goals, Field(description="goals of the benchmark")]


class Benchmark(TypedDict):
    repeats: Repeats
    cases: Annotated[dict[Name, Case], Field(description="benchmark cases")]


class Precision(TypedDict):
    duration: Duration
    scenes: Annotated[dict[Name, Model], Field(description="conveyors by their names")]
    max_evaluations: MaxEvaluations
    repeats: Repeats


class PublishedScene(TypedDict):
    model: Model
    duration: Duration


class PublishedScenes(TypedDict):
    further: Annotated[dict[Name, PublishedScene], Field(description="scenes in addition to the scenes of `precision`")]


class Ride(TypedDict):
    start: Acceleration
    stop: Acceleration
    num: whole("number of amplitudes", 1, MOST_POINTS)
    z0: Height
    duration: Duration


class HardCase(TypedDict):
    label: Annotated[Line, Field(description="label in the figure")]
    model: Model
    duration: Duration


INTEGRATORS = (
    *("RK45", "DOP853", "Radau", "LSODA"),
    *("CyRK DOP853", "CyRK Vern8", "CVODE Adams", "CVODE BDF", "heyoka"),
)


class Stability(TypedDict):
    methods: many(FixedStepMethod, "methods with a fixed step")
    paper_step: Step
    step: span(Step, "time steps")
    contact: mapping("contact with p = 1", {name: MODEL_TYPES[name] for name in ("stiffness", "damping")})
    stiffness: span(MODEL_TYPES["stiffness"], "contact stiffnesses")
    damping: span(MODEL_TYPES["damping"], "contact damping coefficients")
    impact_velocity: span(number("impact velocity", "m/s", gt=0, le=100), "impact velocities")
    conveyor: Annotated[Ride, AfterValidator(check_span), Field(description="the paper's conveyor without chaos")]
    stick: mapping(
        "a conveyor on which the part sticks",
        {name: item for name, item in MODEL_TYPES.items() if name not in ("z0", "vz0")},
        total=False,
    )
    chatter_steps: Steps
    rivals: mapping(
        "other integrators in the difficult cases",
        {
            "integrators": many(Literal[INTEGRATORS], "integrators with events and modes", least=0),
            "tolerance": Tolerance,
            "max_evaluations": MaxEvaluations,
        },
    )
    hard: Annotated[dict[Name, HardCase], Field(description="difficult cases")]


BUDGETED = ("sweeps", "signals", "spectra", "estimates", "critical", "impacts", "dimensions", "attractors", "lyapunov")
Points = whole("number of points", 1, MOST_POINTS)


class SceneBudget(TypedDict):
    points: mapping("points of each table that are compared", dict.fromkeys(BUDGETED, Points))
    tolerances: Tolerances
    pixels: number("share of visibly changed values that is accepted", ge=0, le=1)
    line: number("visible change of a line, as a share of the axis", ge=0, le=1)
    reasons: Annotated[dict[Reference, Line], Field(description="why a table is more accurate than its figure needs")]


class MapCheck(TypedDict):
    maps: many(Name, "sweeps over two parameters")
    points: whole("points of each map", 1, MOST_POINTS)
    cycles: Cycles


class SettlingTimes(TypedDict):
    acceleration: many(Acceleration, "amplitudes of the excitation")
    starts: whole("number of random initial conditions", 1, 10**6)
    z0: interval(HeightNumber, "interval of the random initial heights")
    cycles: Cycles
    seed: Seed


Factor = number("factor by which a parameter is increased and decreased", gt=1, le=1e3)


class Curves(TypedDict):
    doublings: whole("doublings that are followed in two parameters", 0, 12)
    factors: mapping("range of each parameter", dict.fromkeys(("damping", "stiffness", "frequency", "angle"), Factor))
    amplitude: interval(number("a_z/g", gt=0, le=1e3), "range of a_z/g")
    step: number("longest step in x, y, log a_z/g and the logarithm of the parameter", gt=0, le=1)
    points: whole("largest number of points on each side of a curve", 10, 10**5)


class Sensitivity(TypedDict):
    longest_period: Period
    most: whole("number of bifurcations of each kind, those at the lowest amplitudes", 1, 10**4)
    doublings: whole("doublings whose derivatives are extrapolated", 1, 12)
    rest: mapping("initial condition of Fig. 3", {"z0": HeightNumber, "vz0": Velocity})
    critical: Annotated[Name, Field(description="entry of `critical` over the amplitude alone")]
    heights: whole("number of amplitudes of this entry", 1, 1000)
    curves: Annotated[Curves, Field(description="bifurcation curves in two parameters")]


class Scaling(TypedDict):
    points: many(whole("points", 1000, 10**10), "points of a map")
    made_whole: whole("up to this number of points all shards are computed", 1000, 10**9)
    conveyors: many(whole("conveyors", 10, 10**6), "numbers of conveyors")
    threads: many(whole("threads", 1, 256), "numbers of threads")
    shards: many(whole("shards", 1, 1000), "numbers of shards")
    shared_points: whole("points of the maps over threads and shards", 1000, 10**8)


class Operating(TypedDict):
    acceleration: Accelerations
    resolution: Resolution
    height: interval(number("height above the plate", "m", ge=0, le=10), "initial heights", point=True)
    vz0: interval(Velocity, "initial velocities", point=True)
    psi0: interval(MODEL_TYPES["psi0"], "phases of the excitation", point=True)
    starts: whole("random initial conditions per amplitude", 16, 10**6)
    seed: Seed
    followed: whole("initial conditions per attractor whose mean velocity is computed", 2, 1000)
    cycles: whole("cycles over which a mean velocity is taken", 10, 10**6, "excitation cycles")
    same_velocity: number("relative difference up to which velocities are equal", "of the larger velocity", gt=0, lt=1)
    tolerance: Tolerance


DEVIATION = number("relative standard deviation", "of the value in the model", ge=0, le=1)


class Parts(TypedDict):
    friction: DEVIATION
    damping: DEVIATION
    stiffness: DEVIATION
    mass: DEVIATION
    acceleration: DEVIATION
    calibrated: NotRequired[
        Annotated[
            bool, Field(description="draw friction, damping and stiffness from the samples of the calibration, too")
        ]
    ]
    seed: Seed


class Transit(TypedDict):
    acceleration: Accelerations
    length: number("length of the track", "m", ge=1e-3, le=1e4)
    longest: number("time after which a part is late", "s", gt=0, le=1e5)
    parts: whole("parts with random initial conditions per amplitude", 8, 10**6)


class Drift(TypedDict):
    amplitudes: whole("largest number of amplitudes", 1, 10**4)
    runs: whole("initial conditions per amplitude", 4, 10**5)
    forgotten: whole("excitation cycles before the first sample", 0, 10**6, "excitation cycles")
    cycles: whole("excitation cycles of each run", 64, 10**6, "excitation cycles")
    lengths: many(
        number("length of a track", "transit.length", gt=0, le=1e3), "lengths of tracks", check=check_ascending
    )


class Advice(TypedDict):
    margin: number("relative error of the amplitude within which the advice must hold", gt=0, lt=1)
    changes: mapping(
        "changes of single parameters, up and down",
        {
            name: number(f"change of {name}", UNITS[name], gt=0)
            for name in ("angle", "frequency", "friction", "inclination", "phase_shift")
        },
    )
    part_length: NotRequired[number("length of a part in the feeding direction", "m", gt=0, le=10)]


class Throws(TypedDict):
    throw_number: span(number("throw number a_z/(g cos α)", gt=0, le=100), "throw numbers")
    starts: whole("random initial conditions per throw number", 16, 10**6)
    followed: whole("initial conditions per attractor whose mean velocity is computed", 2, 1000)


class Track(TypedDict):
    acceleration: Acceleration
    inclination: span(MODEL_TYPES["inclination"], "inclinations of the track")
    phase_shift: span(MODEL_TYPES["phase_shift"], "phase shifts of the drive")
    starts: whole("random initial conditions per inclination", 2, 10**6)
    cycles: whole("cycles that the feeding motion is followed for, at least", 4, 10**6, "excitation cycles")


class DriveSearch(TypedDict):
    parts: whole("parts per design", 8, 10**6)
    longest: number("time for which a part is followed", "s", gt=0, le=1e5)


class Drive(TypedDict):
    bounds: mapping(
        "search interval of each parameter",
        {
            name: interval(MODEL_TYPES[name], DESCRIPTIONS[name])
            for name in ("acceleration", "frequency", "angle", "phase_shift")
        },
    )
    displacement: number("largest amplitude of the drive's displacement, â/ω²", "m", gt=0, le=1)
    velocity: number("least useful velocity of the slowest 5 % of the parts", "m/s", gt=0, le=100)
    impact_speed: number("largest impact speed that a design may have", "m/s", gt=0, le=100)
    back: number("largest share of the parts that may move back", ge=0, lt=1)
    search: Annotated[DriveSearch, Field(description="parts of each design of the search")]
    drawn: whole("random designs of the first generation", 4, 10**6)
    population: whole("population of NSGA-II", 4, 10**4)
    generations: whole("generations of NSGA-II", 4, 10**5)
    settled: number("growth of the hypervolume in the last quarter that counts as settled", "1", gt=0, le=1)
    seeds: many(Seed, "seeds of the random numbers")
    checked: whole("designs of the front that are confirmed by the transit of all parts", 1, 1000)
    recommended: whole("recommended settings", 1, 100)


class Excitation(TypedDict):
    measured: NotRequired[Annotated[Line, Field(description="CSV file of an accelerometer, relative to this overlay")]]
    unit: word("unit of the accelerations in the file", "m/s²", "g")
    mount: number("angle of the sensor's axis x above the track, for columns x and z", "rad", ge=-3.1416, le=3.1416)


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


# [amplitude, initial height]
Portrait = Annotated[tuple[Acceleration, HeightNumber], Strict(False), AfterValidator(list)]


class FigureSettings(TypedDict, total=False):
    acceleration: Acceleration
    z0: HeightNumber
    critical_acceleration: Acceleration
    critical_height: HeightNumber
    two_states: interval(Acceleration, "interval with two states of motion")
    first_positive: Acceleration
    begin: number("time at which the plot begins", "s", ge=0, le=1e6)
    highest: number("largest frequency of the plot", "Hz", gt=0, le=1e6)
    portraits: Annotated[list[Portrait], Field(min_length=3, max_length=3, description="three phase portraits")]
    transient: number("time that is left out", "s", ge=0, le=1e6)
    longest_period: Period
    lowest_exponent: number("lowest Lyapunov exponent of the plot", "1/s", ge=-1e6, le=1e6)
    paper_step: Step
    equal_error: number("error at which methods are compared, in units of the plate's motion", gt=0, le=1)
    paper_error: number("error of the paper's fit", "m²", gt=0, le=1)


class Figure(TypedDict):
    title: Annotated[Line, Field(description="title")]
    section: Annotated[Line, Field(description="section of the paper")]
    paper_only: NotRequired[Annotated[Line, Field(description="why only the paper's conveyor has this figure")]]
    needs: word("motion that the figure needs", "feeding", "vertical", "nothing")
    tables: Annotated[dict[Name, Reference], Field(description="tables by the roles that the plot script knows")]
    settings: NotRequired[Annotated[FigureSettings, Field(description="numbers that the plot script draws")]]
    caption_tables: NotRequired[Annotated[dict[Name, Reference], Field(description="further tables of the caption")]]


class Companion(TypedDict):
    maps: many(Name, "sweeps over two parameters")
    opening: Annotated[Name, Field(description="preset with which the page opens")]
    presets: Annotated[dict[Name, Model], Field(description="conveyors of the page", min_length=1)]
    tolerance: Tolerance
    cycles: whole("cycles within which a motion must repeat itself", 256, 10**9, "excitation cycles")
    separation: number("initial distance of the second part", "m", gt=0, le=1)


class Config(TypedDict):
    __pydantic_config__ = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)

    prefix: text(
        "folder below results/ and figures/ for the results of this config",
        f"(|{NAME})",
        f"a folder name of at most {LONGEST_NAME} letters, digits, - and _, or nothing",
    )
    model: mapping("the conveyor and the part", MODEL_KEYS)
    solver: Annotated[Solver, Field(description="default settings of all trajectories")]
    sharing: Annotated[Sharing, Field(description="division of sweeps into jobs")]
    sweeps: Annotated[dict[Name, Sweep], Field(description="trajectories for all combinations of axes")]
    estimates: Annotated[dict[Name, Estimate], Field(description="Lyapunov exponents by finite differences (Eq. 23)")]
    critical: Annotated[dict[Name, Critical], Field(description="initial heights at which the state of motion changes")]
    regressions: Annotated[dict[Name, Regression], Field(description="fits of Eq. 13 to critical heights")]
    dimensions: Annotated[dict[Name, Dimension], Field(description="fractal dimensions of phase portraits")]
    signals: Annotated[dict[Name, Signal], Field(description="motion of part and plate at given times")]
    spectra: Annotated[dict[Name, Spectrum], Field(description="amplitude spectra of the velocities")]
    impacts: Annotated[dict[Name, Impacts], Field(description="first impacts of parts that start in the air")]
    orbits: Annotated[Orbits, Field(description="periodic orbits of the vertical motion")]
    certificates: Annotated[Certificates, Field(description="proofs of orbits, bifurcations and chaos")]
    attractors: Annotated[Attractors, Field(description="stroboscopic states over the amplitude")]
    lyapunov: Annotated[Lyapunov, Field(description="Lyapunov exponents of the attractors")]
    witnesses: Annotated[Witnesses, Field(description="tests for chaos")]
    claims: Annotated[dict[NameOfClaim, Claim], Field(description="claims of the paper")]
    uncertainty: Annotated[Uncertainty, Field(description="check of the claims with tighter tolerances")]
    benchmark: Annotated[Benchmark, Field(description="speed and error of the solver and of the paper's method")]
    precision: Annotated[Precision, Field(description="error against cost of all methods")]
    published_scenes: Annotated[PublishedScenes, Field(description="benchmark for other solvers")]
    stability: Annotated[Stability, Field(description="limits of stability of the methods")]
    scene_budget: Annotated[SceneBudget, Field(description="accuracy that each figure needs")]
    map_check: Annotated[MapCheck, Field(description="check of state maps by brute force")]
    settling_times: Annotated[SettlingTimes, Field(description="time until a motion settles")]
    sensitivity: Annotated[Sensitivity, Field(description="derivatives of bifurcations and critical heights")]
    scaling: Annotated[Scaling, Field(description="cost of sweeps by size, threads and shards")]
    operating: Annotated[Operating, Field(description="shares of the attractors over the amplitude")]
    parts: Annotated[Parts, Field(description="how parts differ")]
    transit: Annotated[Transit, Field(description="velocities of parts along a track over the amplitude")]
    drift: Annotated[Drift, Field(description="drift and diffusion in chaos, and the spread over the track's length")]
    advice: Annotated[Advice, Field(description="advice on where to run the conveyor")]
    track: Annotated[Track, Field(description="velocity over inclination and phase shift")]
    throws: Annotated[Throws, Field(description="comparison with the textbook theory of throw conveyors")]
    drive: Annotated[Drive, Field(description="search for the settings of the drive")]
    excitation: Annotated[Excitation, Field(description="the drive from an accelerometer file")]
    calibration: Annotated[Calibration, Field(description="parameters from measured velocities")]
    calibration_study: Annotated[CalibrationStudy, Field(description="simulation study of the calibration")]
    identification: Annotated[Identification, Field(description="parameters that the paper's numbers imply")]
    figures: Annotated[dict[Name, Figure], Field(description="figures")]
    figures_on_request: Annotated[dict[Name, Figure], Field(description="figures that only an explicit target makes")]
    companion: Annotated[Companion, Field(description="the interactive page")]
    archive: mapping(
        "the archive of figures, tables and sources",
        {"megabytes": number("largest size of the archive", "MB", gt=0, le=1e6)},
    )


MODEL = TypeAdapter(Config)
