"""All keys of the config in their canonical order, with description, unit and range."""

from functools import partial
from typing import Annotated, Any, NotRequired

from pydantic import AfterValidator, ConfigDict, Field, Strict, TypeAdapter, WrapValidator, with_config
from typing_extensions import TypedDict

from scripts.conveyor.parameters import DESCRIPTIONS, FIXED_STEP_METHODS, TENSION_MODES

from .types import (
    AXIS_TYPES,
    LONGEST_NAME,
    MODEL_TYPES,
    MOST_POINTS,
    NAME,
    Axes,
    Model,
    Name,
    Reference,
    as_written,
    axis,
    check_ascending,
    check_span,
    interval,
    line,
    many,
    mapping,
    named,
    number,
    parameter,
    span,
    text,
    whole,
    word,
)

positive = partial(number, gt=0)
count = partial(whole, least=1, most=10**9)
Acceleration, Accelerations = MODEL_TYPES["acceleration"], AXIS_TYPES["acceleration"]
Height = MODEL_TYPES["z0"]
HeightNumber, Velocity = parameter("z0", "height above the mean position of the plate"), parameter("vz0")
Duration = positive("simulated time of a run", "s", le=1e6)
METHODS = ("event", *FIXED_STEP_METHODS)
Method = word("event is the event-driven solver, the other methods have a fixed step", *METHODS)
Methods = many(Method, "methods; the second and further ones make tables of their own, NAME_METHOD")
Tolerance = number("relative error per step of the method event", ge=1e-14, le=1e-2)
Tolerances = many(Tolerance, "relative tolerances")
Step = number("time step of the fixed-step methods", "s", ge=1e-12, le=1e-1)
Steps = many(Step, "time steps of the fixed-step methods")
Epsilon = number("size of the perturbation, in units of the perturbed parameter", ge=1e-15, le=1)
Begin = number("time of the first sample", "s", ge=0, le=1e6)
Interval = positive("time between samples", "excitation cycles", le=1e3)
Seed = whole("seed of the random numbers", 0, 2**32 - 1)
Cycles = whole("length of a run", 256, 10**9, "excitation cycles")
Samples = whole("number of samples", 8, 10**8)
ManySamples = many(whole("number of samples", 100, 10**8), "numbers of samples")
Theiler = whole("pairs of samples closer in time than this are left out", 0, 10**8, "samples")
Transient = whole("excitation cycles before recording", 0, 10**9, "excitation cycles")
Strobes = count("stroboscopic samples, one per excitation cycle")
BlockCycles, Blocks = count("cycles per block", unit="excitation cycles"), whole("number of blocks", 2, 10**6)
Share = number("share of visibly changed values that is accepted", ge=0, le=1)
Period = whole("longest period considered", 1, 64, "excitation cycles")
Starts = whole("number of random initial conditions", 1, 10**6)
Repeats = count("repetitions")
MaxEvaluations = count("force evaluations after which a peer method is stopped")
ProcessorTime = positive("time after which a run is not repeated", "s of processor time", le=3600)
Resolution = positive("width to which a bracket is halved", "m/s²", le=1e4)
Heights = interval(HeightNumber, "interval of the random initial heights")
MeanVelocityError = positive("relative error of the mean velocity", le=1e300)
BITS, ORDER = whole("bits of the interval arithmetic", 53, 4096), whole("order of the Taylor series", 4, 200)
LAST_TERMS = positive("size of the last terms of the Taylor series, in g/ω² and g/ω", le=1e-3)
Kept = Annotated[number("number", ge=-1e300, le=1e300), WrapValidator(as_written)]
CLAIMS = tuple(f"C{place:02d}" for place in range(1, 24))
Claims = many(word("claim of the paper", *CLAIMS), "claims that are checked with tighter tolerances", least=0)
FIT = {
    "A": number("parameter A of Eq. 13", "m²/s²", ge=-1e6, le=1e6),
    "B": number("parameter B of Eq. 13", "m/s²", ge=-1e6, le=1e6),
    "C": number("parameter C of Eq. 13", "m", ge=-1e6, le=1e6),
}


def optional(keys: dict[str, Any]) -> dict[str, Any]:
    return {name: NotRequired[item] for name, item in keys.items()}


def one_each(names: tuple[str, ...], item: Any, description: str, total: bool = True) -> Any:
    """A mapping in which all names have a value of the same type."""
    return mapping(description, dict.fromkeys(names, item), total)


SOLVER = {
    "duration": Duration,
    "method": Method,
    "tolerance": Tolerance,
    "step": Step,
    "settling": whole(
        "an initial condition that has not settled by then may be chaotic", 256, 10**9, "excitation cycles"
    ),
}
Seconds = positive("measured time on one core", "s", le=1e6)
Pair = interval(Seconds, "[time where the plate cannot throw parts, time where it can]", point=True)
Megabytes = positive("memory", "MB", le=1e6)
COSTS = {
    "cycle": positive("time per excitation cycle by the method event, on one core", "s", le=1e6),
    "fixed_step": positive("time per step of a fixed-step method, on one core", "s", le=1e6),
    "start": one_each(
        ("alone", "chaos", "orbits"), Pair, "cost per initial condition, by what is known of its conveyor"
    ),
    "conveyor": one_each(("chaos", "orbits"), Pair, "cost of the search for attractors, per conveyor"),
}
SHARING = {
    "job_seconds": positive("wanted duration of a job on two cores", "s", le=1e6),
    "most_jobs": whole("largest number of jobs per sweep", 1, 10**5),
    "core_hours": positive("largest estimated cost of a sweep", "h", le=1e9),
    "seconds": mapping("measured costs from which a sweep's cost is estimated", COSTS),
    "megabytes": one_each(("program", "row", "written_row"), Megabytes, "memory of a job and of each row"),
}

FOLLOWED = {"axes": Axes} | optional(
    {"model": Model, "method": Method, "methods": Methods, "tolerance": Tolerance, "step": Step}
)
TIMED = FOLLOWED | {"duration": NotRequired[Duration]}
SWEEP = TIMED | {
    "needs": NotRequired[word("vertical leaves out the feeding velocity, which is faster", "feeding", "vertical")]
}
ESTIMATE = TIMED | {
    "perturb": word("perturbed parameter", "psi0", "z0", "vz0"),
    "epsilon": Epsilon,
    "output": word("compared state variable", "x", "vx", "z", "vz"),
    "last": number("share of the run that is averaged", "of the duration", gt=0, lt=1),
    "samples": whole("samples in this share", 2, 10**8),
}
CRITICAL = TIMED | {
    "scan": axis(HeightNumber, "initial heights that are scanned for changes", least=2, check=check_ascending),
    "resolution": number("accuracy of a critical height", "m", ge=1e-15, le=1),
}
REGRESSION = {
    "critical": Annotated[Name, Field(description="entry of `critical` that Eq. 13 is fitted to")],
    "acceleration": NotRequired[interval(Acceleration, "amplitudes of the fitted data")],
    "bounds": mapping(
        "search interval of each parameter", {name: interval(item, f"bounds of {name}") for name, item in FIT.items()}
    ),
    "seed": Seed,
    "evaluations": count("largest number of evaluations"),
    "valley": span(FIT["B"], "values of B along the valley"),
    "paper": NotRequired[mapping("the paper's parameters", FIT)],
}
DIMENSION = FOLLOWED | {
    "begin": Begin,
    "interval": Interval,
    "samples": Samples,
    "estimator": word("estimator of the fractal dimension", "paper", "box", "correlation"),
    "octaves": NotRequired[whole("box sizes are 1/2 to 1/2^octaves of the extent", 3, 30)],
    "theiler": NotRequired[Theiler],
    "largest_error": NotRequired[positive("estimates with a larger error are left out", le=2)],
}
SIGNAL = TIMED | {"times": span(number("time", "s", ge=0, le=1e6), "times of the samples")}
SPECTRUM = TIMED | {
    "last": positive("share of the run that is transformed", "of the duration", le=1),
    "samples_per_cycle": whole("samples per excitation cycle", 8, 10**6),
}
IMPACTS = {"axes": Axes, "model": NotRequired[Model]}

SEED_ORBIT = {"acceleration": Acceleration, "z0": Height, "vz0": NotRequired[Velocity]}
SeedOrbits = Annotated[
    list[mapping("initial condition near an orbit", SEED_ORBIT)], Field(min_length=1, max_length=1000)
]
ORBITS = {
    "seeds": NotRequired[Annotated[SeedOrbits, Field(description="initial conditions of the first orbits")]],
    "limits": interval(Acceleration, "amplitudes between which branches are followed"),
    "max_period": whole("longest period that is followed", 1, 64, "excitation cycles"),
    "cycles": whole("cycles until a seed is near its orbit", 64, 10**9, "excitation cycles"),
    "model": NotRequired[Model],
}
CERTIFIED_CHAOS = {
    "acceleration": many(Acceleration, "amplitudes of the proofs of chaos", least=0, check=list),
    "size": positive("largest half axis of a parallelogram along the unstable direction, in g/ω² and g/ω", le=1),
    "ratio": positive("unstable half axis over stable half axis", le=100),
    "longest": whole("longest excursion searched for", 2, 64, "excitation cycles"),
    "bits": BITS,
    "order": ORDER,
    "tolerance": LAST_TERMS,
}
CERTIFICATES = {
    "acceleration": Accelerations,
    "also": many(Acceleration, "further amplitudes", least=0, check=list),
    "longest_period": Period,
    "doubled_limit": Acceleration,
    "bits": BITS,
    "order": ORDER,
    "tolerance": LAST_TERMS,
    "closeness": positive("largest distance of a proved orbit from the stored one, in g/ω² and g/ω", le=1),
    "doublings": whole("period doublings that are proved", 0, 8),
    "half_width": positive("half width of the bracket of a doubling", "m/s²", le=1e-2),
    "half_arc": positive("half the arc of a branch around its fold, in g/ω², g/ω and g", le=1e-2),
    "chaos": mapping("proofs of chaos", CERTIFIED_CHAOS),
}
ATTRACTORS = {
    "acceleration": Accelerations,
    "transient": Transient,
    "strobes": Strobes,
    "model": NotRequired[Model],
    "tolerance": NotRequired[Tolerance],
}
LYAPUNOV = {"cycles": BlockCycles, "blocks": Blocks, "tolerance": NotRequired[Tolerance]}
WITNESSES = {
    "strobes": whole("samples of the 0-1 test", 100, 10**8),
    "seed": Seed,
    "significant": number("standard errors by which an exponent is positive", ge=0, le=1e6),
    "tolerance": NotRequired[Tolerance],
}

QUANTITY = {
    "is": line("quantity and unit"),
    "paper": Annotated[Kept | None, Field(description="the paper's number, or null")],
    "accepted": interval(Kept | None, "[least, largest] number that supports the claim; null for no bound", point=True),
    "because": text("reason for the interval", r"[\s\S]{3,}", "a reason of at least three letters"),
}
CLAIM = {
    "where": line("section or figure of the paper"),
    "statement": line("the claim"),
    "finding": line("function of scripts/claims, as MODULE.FUNCTION"),
    "settings": NotRequired[mapping("settings of the finding", {"acceleration": Acceleration}, total=False)],
    "quantities": named("quantities that the finding returns", mapping("a quantity", QUANTITY), min_length=1),
    "tables": named("tables by the roles that the finding knows", Reference),
}
UNCERTAINTY = {"tighter": number("factor of the tighter tolerances", gt=1, le=1e4), "claims": Claims}

Speed = Annotated[positive("speed in units of explicit Euler", le=1e300), WrapValidator(as_written)]
CASE = {
    "motion": line("state of motion"),
    "model": Model,
    "duration": NotRequired[Duration],
    "loosest": NotRequired[Tolerance],
    "step": NotRequired[Step],
    "compared": positive("time over which the error is measured", "s", le=1e6),
    "wanted": mapping("goals of the benchmark", {"error": MeanVelocityError, "speed": Speed, "aim": Speed}),
}
BENCHMARK = {"repeats": Repeats, "cases": named("benchmark cases", mapping("a case", CASE))}
INTEGRATORS = ("RK45", "DOP853", "Radau", "LSODA", "heyoka")
PeerTolerances = many(Tolerance, "relative tolerances", least=0)
PeersOfAKind = one_each(INTEGRATORS, PeerTolerances, "tolerances of each integrator", total=False)
PRECISION = {
    "duration": Duration,
    "scenes": named("conveyors by their names", Model),
    "tolerances": Tolerances,
    "steps": Steps,
    "peers": one_each(("sign", "events", "modes"), PeersOfAKind, "peers by their treatment of impacts", total=False),
    "max_evaluations": MaxEvaluations,
    "repeats": Repeats,
    "seconds": ProcessorTime,
}
ExponentPairs = {
    "acceleration": Acceleration,
    "z0": Height,
    "durations": many(Duration, "durations"),
    "epsilon": Epsilon,
}
PRECISION_ESTIMATES = {
    "exponent": mapping("largest Lyapunov exponent by finite differences", ExponentPairs),
    "dimension": mapping("fractal dimension", {"points": ManySamples, "repeats": Repeats}),
    "fit": mapping("fit of Eq. 13", {"evaluations": whole("largest number of evaluations", 4, 10**9)}),
    "seed": Seed,
}
RIDE = {
    "start": Acceleration,
    "stop": Acceleration,
    "num": whole("number of amplitudes", 1, MOST_POINTS),
    "z0": Height,
    "duration": Duration,
}
HARD = {"label": line("label in the figure"), "model": Model, "duration": Duration}
STICK = {name: item for name, item in MODEL_TYPES.items() if name not in ("z0", "vz0")}
STABILITY = {
    "methods": many(word("method with a fixed step", *FIXED_STEP_METHODS), "methods with a fixed step"),
    "paper_step": Step,
    "step": span(Step, "time steps"),
    "contact": mapping("contact with p = 1", {name: MODEL_TYPES[name] for name in ("stiffness", "damping")}),
    "stiffness": span(MODEL_TYPES["stiffness"], "contact stiffnesses"),
    "damping": span(MODEL_TYPES["damping"], "contact damping coefficients"),
    "impact_velocity": span(positive("impact velocity", "m/s", le=100), "impact velocities"),
    "conveyor": Annotated[mapping("the paper's conveyor without chaos", RIDE), AfterValidator(check_span)],
    "stick": mapping("a conveyor on which the part sticks", STICK, total=False),
    "chatter_steps": Steps,
    "hard": named("difficult cases", mapping("a difficult case", HARD)),
}
PERTURBED = {
    "acceleration": Acceleration,
    "z0": Height,
    "perturb": word("perturbed parameter", "psi0", "z0"),
    "output": word("compared state variable", "vx", "z"),
}
PAPER_EXPONENT = {
    "step": Step,
    "epsilon": Epsilon,
    "duration": Duration,
    "cases": one_each(
        ("orbit_phase", "orbit_height", "chaos_phase"), mapping("a case", PERTURBED), "perturbed motions"
    ),
    "epsilons": many(Epsilon, "sizes of the perturbation"),
    "durations": many(Duration, "durations"),
    "steps": Steps,
}
PAPER_DIMENSION = {
    "samples": ManySamples,
    "correlated": whole("largest number of samples of a correlation sum", 100, 10**8),
    "theiler": Theiler,
    "portraits": one_each(("second", "chaos"), Model, "conveyors of the phase portraits"),
    "begin": positive("time of the first sample", "s", le=1e6),
    "interval": Interval,
    "paper_interval": Interval,
    "durations": many(Duration, "durations"),
    "octaves": whole("box sizes are 1/2 to 1/2^octaves of the extent", 2, 30),
}
STABILITY_ESTIMATES = {
    "exponent": mapping("largest Lyapunov exponent by finite differences (Eq. 23)", PAPER_EXPONENT),
    "dimension": mapping("fractal dimension by box counting", PAPER_DIMENSION),
    "seed": Seed,
}
SHORTENED = {
    "settling": Cycles,
    "duration": Duration,
    "begin": Begin,
    "samples": Samples,
    "transient": Transient,
    "strobes": Strobes,
    "cycles": BlockCycles,
    "blocks": Blocks,
}
Shortened = mapping("settings of a shortened variant", SHORTENED, total=False)
DRAWN = ("sweeps", "signals", "spectra", "estimates", "critical", "impacts", "dimensions", "attractors", "lyapunov")
SHORTER = ("sweeps", "signals", "spectra", "critical", "impacts", "attractors", "lyapunov", "dimensions", "estimates")
Points = whole("number of points", 1, MOST_POINTS)
SCENE_BUDGET = {
    "shortened": one_each(SHORTER, Shortened, "settings that every variant shortens", total=False),
    "points": one_each(DRAWN, Points, "points of each table that are compared"),
    "shifts": many(number("shift of the initial height", "m", ge=-1, le=1), "shifts of the initial height"),
    "tolerances": Tolerances,
    "pixels": Share,
    "line": number("visible change of a line, as a share of the axis", ge=0, le=1),
    "reasons": Annotated[
        dict[Reference, line("reason")], Field(description="why a table is more accurate than its figure needs")
    ],
}
RIGID_PART = {
    "doublings": whole("period doublings that are followed", 1, 16),
    "z0": Height,
    "duration": Duration,
    "close": positive("distance at which a motion repeats itself, in parts of the jump height", le=1),
    "margin": positive("amplitude steps in which a period is followed", "m/s²", le=1e4),
    "resolution": Resolution,
}
Amplitudes = many(Acceleration, "amplitudes of the excitation")
SETTLING_TIMES = {"acceleration": Amplitudes, "starts": Starts, "z0": Heights, "cycles": Cycles, "seed": Seed}
Factor = number("factor by which a parameter is increased and decreased", gt=1, le=1e3)
CURVES = {
    "doublings": whole("doublings that are followed in two parameters", 0, 12),
    "factors": one_each(("damping", "stiffness", "frequency", "angle"), Factor, "range of each parameter"),
    "amplitude": interval(positive("a_z/g", le=1e3), "range of a_z/g"),
    "step": positive("longest step in x, y, log a_z/g and the logarithm of the parameter", le=1),
    "points": whole("largest number of points on each side of a curve", 10, 10**5),
}
SENSITIVITY = {
    "longest_period": Period,
    "doublings": whole("doublings whose derivatives are extrapolated", 1, 12),
    "rest": mapping("initial condition of Fig. 3", {"z0": HeightNumber, "vz0": Velocity}),
    "critical": Annotated[Name, Field(description="entry of `critical` over the amplitude alone")],
    "heights": whole("number of amplitudes of this entry", 1, 1000),
    "difference": number("relative change of a parameter in the check by finite differences", ge=1e-7, le=1e-2),
    "agreement": positive("accepted difference between both derivatives", le=1),
    "curves": mapping("bifurcation curves in two parameters", CURVES),
}
SCALING = {
    "points": many(whole("points", 1000, 10**10), "points of a map"),
    "made_whole": whole("up to this number of points all shards are computed", 1000, 10**9),
    "conveyors": many(whole("conveyors", 10, 10**6), "numbers of conveyors"),
    "threads": many(whole("threads", 1, 256), "numbers of threads"),
    "shards": many(whole("shards", 1, 1000), "numbers of shards"),
    "shared_points": whole("points of the maps over threads and shards", 1000, 10**8),
}
OPERATING = {
    "acceleration": Accelerations,
    "resolution": Resolution,
    "height": interval(number("height above the plate", "m", ge=0, le=10), "initial heights", point=True),
    "vz0": interval(Velocity, "initial velocities", point=True),
    "psi0": interval(MODEL_TYPES["psi0"], "phases of the excitation", point=True),
    "starts": whole("random initial conditions per amplitude", 16, 10**6),
    "seed": Seed,
    "followed": whole("initial conditions per attractor whose mean velocity is computed", 2, 1000),
    "cycles": whole("cycles over which a mean velocity is taken", 10, 10**6, "excitation cycles"),
    "same_velocity": number(
        "relative difference up to which velocities are equal", "of the larger velocity", gt=0, lt=1
    ),
    "tolerance": Tolerance,
}

OBJECTIVES = ("places", "first_velocity", "second_velocity")
# Quantities of claims that scripts/identification/measures.py computes for any conveyor.
NUMBERS_OF_CLAIMS = (
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
NumberOfClaim = word("quantity of a claim, as CLAIM.QUANTITY", *NUMBERS_OF_CLAIMS)
SEARCHED = {
    "friction": interval(number("friction", "1", gt=0, le=10), DESCRIPTIONS["friction"]),
    "loss": interval(number("loss", "1", gt=0, le=2), "damping × contact time / mass"),
    "stiffness": interval(MODEL_TYPES["stiffness"], DESCRIPTIONS["stiffness"]),
    "angle": interval(number("angle", "rad", gt=0, le=1.5707), DESCRIPTIONS["angle"]),
}
EVIDENCE = {
    "without": many(NumberOfClaim, "quantities that are left out", least=0),
    "shifted": Annotated[bool, Strict(), Field(description="add the error of the paper's method at its parameters")],
}
FRONT = {
    "weights": whole("parts into which the weights divide one", 1, 50),
    "least": positive("weight in place of zero", le=1),
    "drawn": whole("random points in the bounds", 10, 10**6),
    "starts": whole("random points that start a least-squares fit", 1, 100),
    "population": whole("population of NSGA-II", 20, 10**4),
    "generations": whole("generations of NSGA-II", 4, 10**5),
    "seeds": many(Seed, "seeds of the random numbers", least=2),
    "worst": positive("misfit from which a member does not count", le=1e3),
    "settled": positive("relative change of the hypervolume that counts as settled", le=1),
    "distance": positive("accepted mean distance between the fronts of two seeds", le=1e3),
}
EDGES = {
    "vertical_acceleration": span(
        positive("amplitude of the vertical acceleration", "m/s²", le=1e4), "scan from below"
    ),
    "further": positive("distance above an edge at which the first state is searched for", "m/s²", le=1e3),
    "resolution": positive("accuracy of an edge", "m/s²", le=10),
}
PROFILES = {
    "points": whole("points of a profile", 3, 1000),
    "confidence": number("confidence level of the intervals", gt=0, lt=1),
}
ToldAt = {name: MODEL_TYPES[name] for name in ("friction", "damping", "stiffness", "angle")}
IDENTIFICATION = {
    "bounds": mapping("search interval of each parameter", SEARCHED),
    "readings": many(word(DESCRIPTIONS["tension"], *TENSION_MODES), "readings of Eqs. 7 and 11"),
    "objectives": one_each(OBJECTIVES, many(NumberOfClaim, "quantities of claims"), "objectives of the search"),
    "evidence": one_each(("all", "end_left_out", "paper_method"), mapping("evidence", EVIDENCE), "sets of evidence"),
    "contacts": one_each(("loss", "stiffness"), whole("number of values", 4, 1000), "contacts in the table of edges"),
    "heights": many(HeightNumber, "initial heights in the table of edges", least=4, check=check_ascending),
    "edges": mapping("edges of the states of motion", EDGES),
    "inside": positive("distance inside the interval of two states at which velocities are measured", "m/s²", le=10),
    "search": mapping("multi-objective search with NSGA-II", FRONT),
    "profiles": mapping("profile likelihoods", PROFILES),
    "told": named(
        "parameters at which the quantities are reported", mapping("changed parameters", ToldAt, total=False)
    ),
}

Portrait = Annotated[
    tuple[Acceleration, HeightNumber],
    Strict(False),
    AfterValidator(list),
    Field(description="[amplitude, initial height]"),
]
FIGURE_SETTINGS = {
    "acceleration": Acceleration,
    "z0": HeightNumber,
    "critical_acceleration": Acceleration,
    "critical_height": HeightNumber,
    "two_states": interval(Acceleration, "interval with two states of motion"),
    "first_positive": Acceleration,
    "begin": number("time at which the plot begins", "s", ge=0, le=1e6),
    "highest": positive("largest frequency of the plot", "Hz", le=1e6),
    "portraits": Annotated[list[Portrait], Field(min_length=3, max_length=3, description="three phase portraits")],
    "transient": number("time that is left out", "s", ge=0, le=1e6),
    "longest_period": Period,
    "lowest_exponent": number("lowest Lyapunov exponent of the plot", "1/s", ge=-1e6, le=1e6),
    "paper_step": Step,
    "paper_error": positive("error of the paper's fit", "m²", le=1),
}
FIGURE = {
    "title": line("title"),
    "section": line("section of the paper"),
    "paper_only": NotRequired[line("why the figure makes sense for the paper's conveyor only")],
    "needs": word("kind of motion that the figure needs", "feeding", "vertical", "nothing"),
    "tables": named("tables by the roles that the plot script knows", Reference),
    "settings": NotRequired[mapping("numbers that the plot script draws", FIGURE_SETTINGS, total=False)],
    "caption_tables": NotRequired[named("further tables of the caption", Reference)],
}
COMPANION = {
    "maps": many(Name, "sweeps over two parameters"),
    "opening": Annotated[Name, Field(description="preset with which the page opens")],
    "presets": named("conveyors of the page", Model, min_length=1),
    "tolerance": Tolerance,
    "cycles": whole("cycles within which a motion must repeat itself", 256, 10**9, "excitation cycles"),
    "separation": positive("initial distance of the second part", "m", le=1),
}
ARCHIVE = {"megabytes": positive("largest size of the archive", "MB", le=1e6)}
PREFIX = f"a folder name of at most {LONGEST_NAME} letters, digits, - and _, or nothing"


def entries(description: str, keys: dict[str, Any]) -> Any:
    return named(description, mapping(f"entry of {description}", keys))


SECTIONS = {
    "prefix": text("folder below results/ and figures/ for the results of this config", f"(|{NAME})", PREFIX),
    "model": mapping("the conveyor and the part", MODEL_TYPES),
    "solver": mapping("default settings of all trajectories", SOLVER),
    "sharing": mapping("division of sweeps into jobs", SHARING),
    "sweeps": entries("trajectories for all combinations of axes", SWEEP),
    "estimates": entries("Lyapunov exponents by finite differences (Eq. 23)", ESTIMATE),
    "critical": entries("initial heights at which the state of motion changes", CRITICAL),
    "regressions": entries("fits of Eq. 13 to critical heights", REGRESSION),
    "dimensions": entries("fractal dimensions of phase portraits", DIMENSION),
    "signals": entries("motion of part and plate at given times", SIGNAL),
    "spectra": entries("amplitude spectra of the velocities", SPECTRUM),
    "impacts": entries("first impacts of parts that start in the air", IMPACTS),
    "orbits": mapping("periodic orbits of the vertical motion", ORBITS),
    "certificates": mapping("computer-assisted proofs of orbits, bifurcations and chaos", CERTIFICATES),
    "attractors": mapping("stroboscopic states over the amplitude", ATTRACTORS),
    "lyapunov": mapping("Lyapunov exponents of the attractors", LYAPUNOV),
    "witnesses": mapping("tests for chaos", WITNESSES),
    "claims": Annotated[
        dict[word("claim of the paper", *CLAIMS), mapping("a claim", CLAIM)], Field(description="claims of the paper")
    ],
    "uncertainty": mapping("check of the claims with tighter tolerances", UNCERTAINTY),
    "benchmark": mapping("speed and error of the solver and of the paper's method", BENCHMARK),
    "precision": mapping("error against cost of all methods", PRECISION),
    "precision_estimates": mapping("error against cost of derived quantities", PRECISION_ESTIMATES),
    "stability": mapping("limits of stability of the methods", STABILITY),
    "stability_estimates": mapping("limits of the paper's estimates", STABILITY_ESTIMATES),
    "scene_budget": mapping("accuracy that each figure needs", SCENE_BUDGET),
    "rigid_part": mapping("rigid bouncing part in place of the contact", RIGID_PART),
    "settling_times": mapping("time until a motion settles", SETTLING_TIMES),
    "sensitivity": mapping("derivatives of bifurcations and critical heights", SENSITIVITY),
    "scaling": mapping("cost of sweeps by size, threads and shards", SCALING),
    "operating": mapping("shares of the attractors over the amplitude", OPERATING),
    "identification": mapping("parameters that the paper's numbers imply", IDENTIFICATION),
    "figures": entries("figures", FIGURE),
    "figures_on_request": entries("figures that only an explicit target makes", FIGURE),
    "companion": mapping("the interactive page", COMPANION),
    "archive": mapping("the archive of figures, tables and sources", ARCHIVE),
}
Config = with_config(ConfigDict(extra="forbid", strict=True))(TypedDict("Config", SECTIONS))
MODEL = TypeAdapter(Config)
