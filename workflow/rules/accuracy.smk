# How accurate, how fast, how robust: the solver against other methods. Rules that take wall times get the machine to
# themselves, those that take processor times do not need it. A time changes whenever it is taken, so that nothing which
# must have equal bytes is made from it.
from workflow.config.sharing import plan, seconds_of


def benchmark_cases():
    """The cases of the benchmark with all defaults, by name."""
    cases = config["benchmark"]["cases"]
    solver = {key: config["solver"][key] for key in ("duration", "step")}
    return {name: {**solver, **case, "model": {**config["model"], **case["model"]}} for name, case in cases.items()}


def scene(wildcards):
    """A param: one scene of the section `precision` with its model."""
    precision = config["precision"]
    model = {**config["model"], **precision["scenes"][wildcards.name]}
    shared = {name: precision[name] for name in ("duration", "tolerances", "steps", "peers", "max_evaluations")}
    return {**shared, "model": model}


def accuracy_rule(name, message, **rest):
    """The rule of a table of the folder of results that the section and the module of its name make."""
    RULES[name] = {
        "stage": f"accuracy.{name}",
        "message": message,
        "output": tables_of("results", name),
        "place": f"accuracy/{name}",
        **({} if "params" in rest else {"params": {"settings": config[name]}}),
        **rest,
    }


def converged_entry(reference):
    """All that a converged table of trajectories depends on, with an axis over the amplitude in any case."""
    entry = settings_of_table(table(*reference.split("/")))
    return entry if "axes" in entry else {**entry, "axes": {"acceleration": entry["acceleration"]}, "duration": None}


def is_budgeted(reference):
    """Whether a table that a figure draws is one of converged trajectories, of a section with a budget."""
    return (
        reference.split("/")[0] in config["scene_budget"]["points"]
        and kind_of(reference) != "witnesses"
        and entry_of(config, reference).get("method", "event") == "event"
    )


DRAWN = {
    figure: [reference for reference in dict.fromkeys(entry["tables"].values()) if is_budgeted(reference)]
    for figure, entry in config["figures"].items()
}
FITTED = config["regressions"].get("height")


accuracy_rule(
    "benchmark",
    "The solver against the paper's method",
    output={**tables_of("results", "benchmark"), "report": result("benchmark.md")},
    timed=("benchmark", "report"),
    **ALONE,
    params={
        "settings": {
            "cases": benchmark_cases(),
            "tolerance": config["solver"]["tolerance"],
            "repeats": config["benchmark"]["repeats"],
        }
    },
)
accuracy_rule("random_points", "Random conveyors and starts", threads=THREADS, mem_mb=2000)
accuracy_rule(
    "precision",
    "Error against work, {wildcards.name}",
    priority=2,
    output={name: table(name) for name in ("precision", "precision_times")},
    timed=("precision_times",),
    names={"name": one_of(config["precision"]["scenes"])},
    place="precision/{name}",
    params={"settings": scene, "timing": {name: config["precision"][name] for name in ("repeats", "seconds")}},
)
accuracy_rule(
    "precision_estimates",
    "Error against work of the estimates",
    input={"critical": table("critical", FITTED["critical"])} if FITTED else {},
    params={"settings": config["precision_estimates"], "model": MODEL_OF_ANY_AMPLITUDE, "fit": FITTED},
)
accuracy_rule("stability", "Where methods stop working")
accuracy_rule(
    "stability_estimates",
    "How far the paper's estimates carry",
    params={"settings": config["stability_estimates"], "model": MODEL_OF_ANY_AMPLITUDE},
)
accuracy_rule(
    "settling_times",
    "After how many cycles starts have settled",
    threads=THREADS,
    params={
        "settings": {**config["settling_times"], "settling": config["solver"]["settling"]},
        "model": MODEL_OF_ANY_AMPLITUDE,
        "tolerance": config["solver"]["tolerance"],
    },
)
# No figure needs it, and it takes long: snakemake results/label_checks.parquet
accuracy_rule(
    "label_checks",
    "Labels of starts, alone and together",
    threads=THREADS,
    runtime=60,
    params={
        "settings": {**config["label_checks"], "settling": config["solver"]["settling"]},
        "model": config["model"],
        "tolerance": config["solver"]["tolerance"],
    },
)
accuracy_rule(
    "scene_budget",
    "What the data of each figure need",
    output=tables_of("results", "scene_budget", "budget_times"),
    timed=("budget_times",),
    priority=1,
    threads=THREADS,
    mem_mb=2000,
    params={
        "settings": config["scene_budget"],
        "entries": {name: converged_entry(name) for names in DRAWN.values() for name in names},
        "drawn": DRAWN,
    },
)
accuracy_rule(
    "rigid_part",
    "A rigid part in place of the contact",
    input={"sweeps": table("sweeps", "amplitudes"), **tables_of("orbits", "folds_and_doublings", "cascade")},
    params={"settings": config["rigid_part"], "entry": resolve(config, "sweeps", "amplitudes")},
)


def case_of_scaling(varied, axes, *, shards=None, threads=THREADS, conveyors=1):
    """A sweep of the chart of scaling, in as many shards as the config says if not in so many."""
    own = {"axes": axes, "needs": "vertical", "duration": 0.02, "tolerance": 1.0e-6}
    entry = resolve(config | {"sweeps": {varied: own}}, "sweeps", varied)
    if conveyors > 1:
        entry["model"] |= {"z0": 0.0}
    shared = plan(config["sharing"], entry)
    if shards:
        rows = math.ceil(shared.points / shards)
        seconds = seconds_of(entry, config["sharing"]["seconds"], rows)
        shared = shared._replace(rows=rows, shards=math.ceil(shared.points / rows), seconds=seconds)
    whole = shards or shared.points <= config["scaling"]["made_whole"]
    return {
        "varied": varied,
        "settings": entry,
        "plan": shared._asdict(),
        "threads": threads,
        "conveyors": conveyors,
        "measured": shared.shards if whole else 1,
    }


def starts_of_scaling(points):
    """Axes of so many starts, nearly, as in Fig. 13."""
    phases = round(points**0.5)
    z0 = {"start": 0.0, "stop": 0.5e-3, "num": points // phases}
    return {"psi0": {"start": 0.0, "stop": 2.0 * math.pi * (1.0 - 1.0 / phases), "num": phases}, "z0": z0}


def cases_of_scaling():
    """All sweeps of the chart of scaling."""
    wanted = config["scaling"]
    few = starts_of_scaling(wanted["shared_points"])
    return [
        *(case_of_scaling("points", starts_of_scaling(points)) for points in wanted["points"]),
        *(
            case_of_scaling(
                "conveyors", {"acceleration": {"start": 20.0, "stop": 45.0, "num": number}}, conveyors=number
            )
            for number in wanted["conveyors"]
        ),
        *(case_of_scaling("threads", few, shards=1, threads=threads) for threads in wanted["threads"]),
        *(case_of_scaling("shards", few, shards=shards) for shards in wanted["shards"]),
    ]


# On request, as it takes minutes: snakemake figures/scaling.pdf
accuracy_rule(
    "scaling",
    "What jobs of sweeps take",
    timed=("scaling",),
    **ALONE,
    params={"settings": config["scaling"], "cases": cases_of_scaling()},
)
accuracy_rule(
    "throughput",
    "Starts that a thread follows in a second",
    timed=("throughput",),
    params={
        "settings": config["throughput"] | {name: config["solver"][name] for name in ("duration", "tolerance", "step")},
        "map_of_starts": case_of_scaling("points", starts_of_scaling(config["throughput"]["starts"]))["settings"],
    },
)
