"""The config, typed: its keys in their canonical order, with units and ranges (see config_types)."""

from typing import Annotated, NotRequired

from pydantic import AfterValidator, ConfigDict, Field, Strict, TypeAdapter, ValidationInfo, with_config
from typing_extensions import TypedDict

from workflow.config_types import (
    AXES,
    LIBRARY,
    LONGEST_NAME,
    NAME,
    NUMBERS,
    PARAMETERS,
    Allowed,
    AtLeastTwo,
    Axes,
    Height,
    Line,
    Model,
    Name,
    Points,
    Reference,
    Scan,
    WholeModel,
    ascending,
    brought,
    did_you_mean,
    distinct,
    forwards,
    interval,
    many,
    number,
    positive,
    span,
    text,
    whole,
    word,
    wrong,
)

Acceleration, Stiffness, Damping = (PARAMETERS[name] for name in ("acceleration", "stiffness", "damping"))
HeightNumber, Velocity = NUMBERS["z0"], NUMBERS["vz0"]
Accelerations = AXES["acceleration"]
Duration = positive(1e6, "s")
Method = word("event", *LIBRARY["METHODS"])
Tolerance = number(1e-14, 1e-2, "relative error")
Step = number(1e-12, 1e-1, "s")
Cycles = whole(256, 10**9, "excitation cycles")
Seed = whole(0, 2**32 - 1)
Count = whole(1, 10**9)
Samples = whole(100, 10**8)
Share = number(0, 1)
FitParameter = number(-1e6, 1e6, "m/s²")
Paper = {"A": number(-1e6, 1e6, "m²/s²"), "B": FitParameter, "C": number(-1e6, 1e6, "m")}
# Numbers without a type of their own keep their spelling, which is that of the first file (see config_files).
Kept = number(-1e300, 1e300, form=lambda value: value)
LEAST_EPSILON = 1e-15
CLAIMS = tuple(f"C{place:02d}" for place in range(1, 24))


def seen(epsilon: float) -> float:
    if epsilon < LEAST_EPSILON:
        raise wrong(f"= {epsilon!r} is lost in the rounding of what it perturbs; give at least {LEAST_EPSILON:g}")
    return epsilon


Epsilon = Annotated[positive(1, "of the perturbed parameter"), AfterValidator(seen)]


def known_claim(name: str) -> str:
    if name not in CLAIMS:
        raise wrong(f"= {name!r} is no statement of the paper; {did_you_mean(name, CLAIMS)}")
    return name


class Solver(TypedDict):
    duration: Duration
    method: Method
    tolerance: Tolerance
    step: Step
    settling: Cycles


Seconds = positive(1e6, "s")
ProcessorTime = positive(3600, "s of processor time")
Megabytes = positive(1e6, "MB")
QuietOrRestless = interval(Seconds, point=True)


class Costs(TypedDict):
    cycle: Seconds
    fixed_step: Seconds
    start: TypedDict("CostOfStart", dict.fromkeys(("alone", "chaos", "orbits"), QuietOrRestless))
    conveyor: TypedDict("CostOfConveyor", dict.fromkeys(("chaos", "orbits"), QuietOrRestless))


class Sharing(TypedDict):
    job_seconds: Seconds
    most_jobs: whole(1, 10**5)
    core_hours: positive(1e9, "h")
    seconds: Costs
    megabytes: TypedDict("Memory", dict.fromkeys(("program", "row", "written_row"), Megabytes))


class Followed(TypedDict):
    axes: Axes
    model: NotRequired[Model]
    method: NotRequired[Method]
    methods: NotRequired[many(Method)]
    tolerance: NotRequired[Tolerance]
    step: NotRequired[Step]


class Timed(Followed):
    duration: NotRequired[Duration]


class Sweep(Timed):
    needs: NotRequired[word("feeding", "vertical")]


class Estimate(Timed):
    perturb: word("psi0", "z0", "vz0")
    epsilon: Epsilon
    output: word("x", "vx", "z", "vz")
    last: number(0, 1, "of the duration", "()")
    samples: whole(2, 10**8)


class Critical(Timed):
    scan: Scan
    resolution: number(1e-15, 1, "m")


class Regression(TypedDict):
    critical: Name
    acceleration: NotRequired[interval(Acceleration)]
    bounds: TypedDict("Bounds", {name: interval(of) for name, of in Paper.items()})
    seed: Seed
    evaluations: Count
    valley: span(FitParameter, AtLeastTwo)
    paper: NotRequired[TypedDict("Paper", Paper)]


class Dimension(Followed):
    begin: number(0, 1e6, "s")
    interval: positive(1e3, "excitation cycles")
    samples: whole(8, 10**8)
    estimator: word("paper", "box", "correlation")
    octaves: NotRequired[whole(3, 30)]
    theiler: NotRequired[whole(0, 10**8)]
    largest_error: NotRequired[positive(2)]


class Signal(Timed):
    times: span(number(0, 1e6, "s"), AtLeastTwo)


class Spectrum(Timed):
    last: positive(1, "of the duration")
    samples_per_cycle: whole(8, 10**6)


class Impacts(TypedDict):
    axes: Axes
    model: NotRequired[Model]


class Seeded(TypedDict):
    acceleration: Acceleration
    z0: Height
    vz0: NotRequired[Velocity]


class Orbits(TypedDict):
    seeds: NotRequired[Annotated[list[Seeded], Field(min_length=1)]]
    limits: interval(Acceleration)
    max_period: whole(1, 64)
    cycles: whole(64, 10**9)
    model: NotRequired[Model]


Bits, Order, LastTerms = whole(53, 4096), whole(4, 200), positive(1e-3)


class Certificates(TypedDict):
    acceleration: Accelerations
    also: list[Acceleration]
    longest_period: whole(1, 64)
    doubled_limit: Acceleration
    bits: Bits
    order: Order
    tolerance: LastTerms
    closeness: positive(1)
    doublings: whole(0, 8)
    half_width: positive(1e-2, "m/s²")
    half_arc: positive(1e-2)
    chaos: TypedDict(
        "Chaos",
        {
            "acceleration": list[Acceleration],
            "size": positive(1),
            "ratio": positive(100),
            "longest": whole(2, 64),
            "bits": Bits,
            "order": Order,
            "tolerance": LastTerms,
        },
    )


class Attractors(TypedDict):
    acceleration: Accelerations
    transient: whole(0, 10**9)
    strobes: Count
    model: NotRequired[Model]
    tolerance: NotRequired[Tolerance]


class Lyapunov(TypedDict):
    cycles: Count
    blocks: whole(2, 10**6)
    tolerance: NotRequired[Tolerance]


class Witnesses(TypedDict):
    strobes: Samples
    seed: Seed
    significant: number(0, 1e6)
    tolerance: NotRequired[Tolerance]


# "is" is no name of a Python class's field.
Quantity = TypedDict(
    "Quantity",
    {
        "is": Line,
        "paper": Kept | None,
        "accepted": interval(Kept | None, point=True),
        "because": text(r"(?s).{3,}", "a reason of at least three letters"),
    },
)


class Claim(TypedDict):
    where: Line
    statement: Line
    finding: Line
    settings: NotRequired[TypedDict("ClaimSettings", {"acceleration": Acceleration}, total=False)]
    quantities: Annotated[dict[Name, Quantity], Field(min_length=1)]
    tables: dict[Name, Reference]


class Uncertainty(TypedDict):
    tighter: number(1, 1e4, "", "(]")
    claims: Annotated[list[Annotated[Name, AfterValidator(known_claim)]], AfterValidator(distinct)]


class Wanted(TypedDict):
    error: positive(1e300)
    speed: number(0, 1e300, "", "(]", form=lambda value: value)
    aim: number(0, 1e300, "", "(]", form=lambda value: value)


class Case(TypedDict):
    motion: Line
    model: Model
    duration: NotRequired[Duration]
    loosest: NotRequired[Tolerance]
    step: NotRequired[Step]
    compared: Duration
    wanted: Wanted


class Benchmark(TypedDict):
    repeats: Count
    cases: dict[Name, Case]


Tolerances = Annotated[list[Tolerance], AfterValidator(distinct)]
INTEGRATORS = ("RK45", "DOP853", "Radau", "LSODA", "heyoka")
Integrators = TypedDict("Integrators", dict.fromkeys(INTEGRATORS, Tolerances), total=False)


class Precision(TypedDict):
    duration: Duration
    scenes: dict[Name, Model]
    tolerances: many(Tolerance)
    steps: many(Step)
    peers: TypedDict("Peers", dict.fromkeys(("sign", "events", "modes"), Integrators), total=False)
    max_evaluations: Count
    repeats: Count
    seconds: ProcessorTime


class PairOfExponent(TypedDict):
    acceleration: Acceleration
    z0: Height
    durations: many(Duration)
    epsilon: Epsilon


class PrecisionEstimates(TypedDict):
    exponent: PairOfExponent
    dimension: TypedDict("Sizes", {"points": many(Samples), "repeats": Count})
    fit: TypedDict("Fit", {"evaluations": whole(4, 10**9)})
    seed: Seed


class Ride(TypedDict):
    start: Acceleration
    stop: Acceleration
    num: Points
    z0: Height
    duration: Duration


class Hard(TypedDict):
    label: Line
    model: Model
    duration: Duration


class Stability(TypedDict):
    methods: many(word(*LIBRARY["METHODS"]))
    paper_step: Step
    step: span(Step, AtLeastTwo)
    contact: TypedDict("Contact", {name: PARAMETERS[name] for name in ("stiffness", "damping")})
    stiffness: span(Stiffness, AtLeastTwo)
    damping: span(Damping, AtLeastTwo)
    impact_velocity: span(positive(100, "m/s"), AtLeastTwo)
    conveyor: Annotated[Ride, AfterValidator(forwards)]
    stick: TypedDict("Plate", {name: PARAMETERS[name] for name in PARAMETERS if name not in ("z0", "vz0")}, total=False)
    chatter_steps: many(Step)
    hard: dict[Name, Hard]


class Pair(TypedDict):
    acceleration: Acceleration
    z0: Height
    perturb: word("psi0", "z0")
    output: word("vx", "z")


class PaperExponent(TypedDict):
    step: Step
    epsilon: Epsilon
    duration: Duration
    cases: TypedDict("Cases", dict.fromkeys(("orbit_phase", "orbit_height", "chaos_phase"), Pair))
    epsilons: many(Epsilon)
    durations: many(Duration)
    steps: many(Step)


class PaperDimension(TypedDict):
    samples: many(Samples)
    correlated: Samples
    theiler: whole(0, 10**8)
    portraits: TypedDict("Portraits", {"second": Model, "chaos": Model})
    begin: Duration
    interval: positive(1e3, "excitation cycles")
    paper_interval: positive(1e3, "excitation cycles")
    durations: many(Duration)
    octaves: whole(2, 30)


class StabilityEstimates(TypedDict):
    exponent: PaperExponent
    dimension: PaperDimension
    seed: Seed


class Shortened(TypedDict, total=False):
    settling: Cycles
    duration: Duration
    begin: number(0, 1e6, "s")
    samples: whole(8, 10**8)
    transient: whole(0, 10**9)
    strobes: Count
    cycles: Count
    blocks: whole(2, 10**6)


SECTIONS = ("sweeps", "signals", "spectra", "estimates", "critical", "impacts", "dimensions", "attractors", "lyapunov")
SHORTENED = ("sweeps", "signals", "spectra", "critical", "impacts", "attractors", "lyapunov", "dimensions", "estimates")


class SceneBudget(TypedDict):
    shortened: TypedDict("ShortenedSections", dict.fromkeys(SHORTENED, Shortened), total=False)
    points: TypedDict("PointsOfSections", dict.fromkeys(SECTIONS, Points))
    shifts: many(number(-1, 1, "m"))
    tolerances: many(Tolerance)
    pixels: Share
    line: Share
    reasons: dict[Reference, Line]


class RigidPart(TypedDict):
    doublings: whole(1, 16)
    z0: Height
    duration: Duration
    close: positive(1)
    margin: positive(1e4, "m/s²")
    resolution: positive(1e4, "m/s²")


class SettlingTimes(TypedDict):
    acceleration: many(Acceleration)
    starts: whole(1, 10**6)
    z0: interval(HeightNumber)
    cycles: Cycles
    seed: Seed


class LabelChecks(TypedDict):
    acceleration: many(Acceleration)
    starts: whole(1, 10**6)
    unshared: whole(0, 10**6)
    z0: interval(HeightNumber)
    seed: Seed


class Scaling(TypedDict):
    points: many(whole(1000, 10**10))
    made_whole: whole(1000, 10**9)
    conveyors: many(whole(10, 10**6))
    threads: many(whole(1, 256))
    shards: many(whole(1, 1000))
    shared_points: whole(1000, 10**8)


class Throughput(TypedDict):
    starts: whole(4, 10**6)
    peers: TypedDict("TimedPeers", dict.fromkeys(INTEGRATORS, Tolerance), total=False)
    batch: whole(1, 64)
    max_evaluations: Count
    repeats: Count
    seconds: ProcessorTime


class RandomPoints(TypedDict):
    count: TypedDict("RandomCount", dict.fromkeys(("around the paper", "whole ranges"), whole(1, 10**7)))
    seed: Seed
    cycles: number(0, 1e6, "excitation cycles", "(]", form=lambda value: value)
    tolerance: Tolerance


Factor = number(1, 1e3, "", "(]")


class Sensitivity(TypedDict):
    longest_period: whole(1, 64)
    doublings: whole(1, 12)
    rest: TypedDict("Rest", {"z0": HeightNumber, "vz0": Velocity})
    critical: Name
    heights: whole(1, 1000)
    difference: number(1e-7, 1e-2)
    agreement: positive(1)
    curves: TypedDict(
        "Curves",
        {
            "doublings": whole(0, 12),
            "factors": TypedDict("Factors", dict.fromkeys(("damping", "stiffness", "frequency", "angle"), Factor)),
            "amplitude": interval(positive(1e3)),
            "step": positive(1),
            "points": whole(10, 10**5),
        },
    )


class Operating(TypedDict):
    acceleration: Accelerations
    resolution: positive(1e4, "m/s²")
    height: interval(number(0, 10, "m"), point=True)
    vz0: interval(Velocity, point=True)
    psi0: interval(NUMBERS["psi0"], point=True)
    starts: whole(16, 10**6)
    seed: Seed
    followed: whole(2, 1000)
    cycles: whole(10, 10**6, "excitation cycles")
    same_velocity: number(0, 1, "of the larger velocity", "()")
    tolerance: Tolerance


def portrait(values: list[float], info: ValidationInfo) -> list[float]:
    """Amplitude and initial height of a phase portrait."""
    return [brought(value, unit, info) for value, unit in zip(values, ("m/s²", "m"), strict=True)]


class FigureSettings(TypedDict, total=False):
    acceleration: Acceleration
    z0: HeightNumber
    critical_acceleration: Acceleration
    critical_height: HeightNumber
    two_states: interval(Acceleration)
    first_positive: Acceleration
    begin: number(0, 1e6, "s")
    highest: positive(1e6, "Hz")
    portraits: Annotated[
        list[
            Annotated[list[number(-1, 1e4, "m/s² or m")], Field(min_length=2, max_length=2), AfterValidator(portrait)]
        ],
        Field(min_length=3, max_length=3),
    ]
    transient: number(0, 1e6, "s")
    longest_period: whole(1, 64)
    lowest_exponent: number(-1e6, 1e6, "1/s")
    paper_step: Step
    paper_error: positive(1, "m²")


OBJECTIVES = ("places", "first_velocity", "second_velocity")
# The numbers of the claims that scripts/identification/measures.py gives for any conveyor.
NumberOfClaim = word(
    "C01.critical_amplitude",
    "C02.lower_end",
    "C02.upper_end",
    "C04.largest_height",
    "C05.velocity_at_lower_end",
    "C05.velocity_at_upper_end",
    "C06.fall",
    "C07.height",
    "C08.height",
    "C09.error",
    "C10.lower_end",
    "C10.upper_end",
)


class Evidence(TypedDict):
    without: Annotated[list[NumberOfClaim], AfterValidator(distinct)]
    shifted: Annotated[bool, Strict(), Allowed("true or false")]


class EdgesOfFirst(TypedDict):
    vertical_acceleration: span(positive(1e4, "m/s²"), AtLeastTwo)
    further: positive(1e3, "m/s²")
    resolution: positive(10, "m/s²")


class FrontSearch(TypedDict):
    weights: whole(1, 50)
    least: positive(1)
    drawn: whole(10, 10**6)
    starts: whole(1, 100)
    population: whole(20, 10**4)
    generations: whole(4, 10**5)
    seeds: Annotated[many(Seed), Field(min_length=2)]
    worst: positive(1e3)
    settled: positive(1)
    distance: positive(1e3)


class Identification(TypedDict):
    bounds: TypedDict(
        "SearchedBounds",
        {
            "friction": interval(number(0, 10, "1", "(]")),
            "loss": interval(number(0, 2, "1", "(]")),
            "stiffness": interval(Stiffness),
            "angle": interval(number(0, 1.5707, "rad", "(]")),
        },
    )
    readings: many(PARAMETERS["tension"])
    objectives: TypedDict("Objectives", dict.fromkeys(OBJECTIVES, many(NumberOfClaim)))
    evidence: TypedDict("EvidenceSets", dict.fromkeys(("all", "end_left_out", "paper_method"), Evidence))
    contacts: TypedDict("Contacts", dict.fromkeys(("loss", "stiffness"), whole(4, 1000)))
    heights: Annotated[list[HeightNumber], Field(min_length=4), AfterValidator(ascending)]
    edges: EdgesOfFirst
    inside: positive(10, "m/s²")
    search: FrontSearch
    profiles: TypedDict("Profiles", {"points": whole(3, 1000), "confidence": number(0, 1, "", "()")})
    told: dict[
        Name,
        TypedDict(
            "Told", {name: PARAMETERS[name] for name in ("friction", "damping", "stiffness", "angle")}, total=False
        ),
    ]


class Figure(TypedDict):
    title: Line
    section: Line
    paper_only: NotRequired[Line]
    needs: word("feeding", "vertical", "nothing")
    tables: dict[Name, Reference]
    settings: NotRequired[FigureSettings]
    caption_tables: NotRequired[dict[Name, Reference]]


# Strict, and without other keys than these; so are the sections below.
class Companion(TypedDict):
    maps: many(Name)
    opening: Name
    presets: Annotated[dict[Name, Model], Field(min_length=1)]
    tolerance: Tolerance
    cycles: Cycles
    separation: positive(1, "m")


class Archive(TypedDict):
    megabytes: positive(1e6, "MB")


@with_config(ConfigDict(extra="forbid", strict=True))
class Config(TypedDict):
    prefix: text(rf"|{NAME}", f"a folder name of at most {LONGEST_NAME} letters, digits, - and _, or nothing")
    model: WholeModel
    solver: Solver
    sharing: Sharing
    sweeps: dict[Name, Sweep]
    estimates: dict[Name, Estimate]
    critical: dict[Name, Critical]
    regressions: dict[Name, Regression]
    dimensions: dict[Name, Dimension]
    signals: dict[Name, Signal]
    spectra: dict[Name, Spectrum]
    impacts: dict[Name, Impacts]
    orbits: Orbits
    certificates: Certificates
    attractors: Attractors
    lyapunov: Lyapunov
    witnesses: Witnesses
    claims: dict[Annotated[Name, AfterValidator(known_claim)], Claim]
    uncertainty: Uncertainty
    benchmark: Benchmark
    precision: Precision
    precision_estimates: PrecisionEstimates
    stability: Stability
    stability_estimates: StabilityEstimates
    scene_budget: SceneBudget
    rigid_part: RigidPart
    settling_times: SettlingTimes
    label_checks: LabelChecks
    random_points: RandomPoints
    sensitivity: Sensitivity
    scaling: Scaling
    throughput: Throughput
    operating: Operating
    identification: Identification
    figures: dict[Name, Figure]
    figures_on_request: dict[Name, Figure]
    companion: Companion
    archive: Archive


MODEL = TypeAdapter(Config)
