"""What the types of the config cannot say: one line for each contradiction between its parts.

Each function takes a config of the right types (see config_model) and gives lines that name the key and the remedy.
"""

import math
from collections.abc import Iterator

from workflow.config_types import LIBRARY, ROOT, did_you_mean, shown
from workflow.known_names import (
    caption_functions,
    compared,
    findings,
    keys_of,
    names_asked,
    names_of_figure,
    names_of_finding,
    names_of_template,
    settings_of_finding,
)
from workflow.sharing import plan
from workflow.tables_of_config import (
    ENTRIES,
    METHODS,
    count_points,
    count_values,
    ends,
    entry_of,
    references,
    resolve,
    values_of,
)

LARGEST_TABLE = 10_000_000  # rows that one job makes, or states that it finds: some hours of a machine
MOST_STEPS = 10**9  # of one run by a fixed-step method: some ten seconds
STEPS_IN_A_CYCLE = 20  # at least: fewer do not show an excitation cycle


def whole_steps(duration: float, step: float) -> bool:
    """Whether a duration (s) is a whole number of steps (s), up to the rounding of both."""
    count = round(duration / step)
    return count > 0 and abs(duration / step - count) <= 1e-9 * count


def step_error(step: float, duration: float, frequency: float) -> str | None:
    """What is wrong with a step (s) of a run (s) at a frequency (Hz), and the remedy."""
    if step > duration:
        return f"is longer than its duration of {duration!r} s"
    largest = 1.0 / (STEPS_IN_A_CYCLE * frequency)
    if step > largest * (1.0 + 1e-9):
        return f"is too long for {frequency:g} Hz; take at most {largest:g} s, 1/{STEPS_IN_A_CYCLE} of a cycle"
    if duration / step > MOST_STEPS:
        return f"makes {duration / step:.0e} steps of {duration!r} s; take at least {duration / MOST_STEPS:g} s"
    if not whole_steps(duration, step):
        return f"does not divide its duration of {duration!r} s; take {duration / max(1, round(duration / step))!r}"
    return None


def overridden_axes(config: dict) -> Iterator[str]:
    for section in ENTRIES:
        for name, entry in config[section].items():
            for axis in sorted(set(entry.get("axes", ())) & set(entry.get("model", ()))):
                yield f"{section}.{name}.model.{axis} is an axis of this entry too; keep one of them"


def steps(config: dict) -> Iterator[str]:
    for section in (*METHODS, "dimensions"):
        for name, own in config[section].items():
            entry = resolve(config, section, name)
            if "step" not in entry:
                continue
            key = f"{section}.{name}.step" if "step" in own else f"solver.step (of {section}.{name})"
            for frequency in values_of(entry, "frequency"):
                duration = entry["duration"]
                if section == "dimensions":
                    duration = entry["begin"] + entry["interval"] * (entry["samples"] - 1) / frequency
                if error := step_error(entry["step"], duration, frequency):
                    yield f"{key} = {entry['step']!r} s {error}"
    exponent = config["stability_estimates"]["exponent"]
    runs = [("step", exponent["step"], duration) for duration in (exponent["duration"], *exponent["durations"])]
    runs += [(f"steps[{place}]", step, exponent["duration"]) for place, step in enumerate(exponent["steps"])]
    runs = [(f"stability_estimates.exponent.{key}", step, duration) for key, step, duration in runs]
    precision = config["precision"]
    runs += [
        (f"precision.steps[{place}]", step, precision["duration"]) for place, step in enumerate(precision["steps"])
    ]
    for name, case in config["benchmark"]["cases"].items():
        key = f"benchmark.cases.{name}.step" if "step" in case else f"solver.step (of benchmark.cases.{name})"
        solver = config["solver"] | case
        runs.append((key, solver["step"], solver["duration"]))
    for key, step, duration in runs:
        if error := step_error(step, duration, config["model"]["frequency"]):
            yield f"{key} = {step!r} s {error}"


def perturbations(config: dict) -> Iterator[str]:
    pairs = [
        (f"estimates.{name}", entry["perturb"], entry["epsilon"], values_of(entry, entry["perturb"]))
        for name in config["estimates"]
        for entry in [resolve(config, "estimates", name)]
    ]
    exponent = config["stability_estimates"]["exponent"]
    for name, case in exponent["cases"].items():
        values = [case.get(case["perturb"], config["model"][case["perturb"]])]
        key = f"stability_estimates.exponent.cases.{name}"
        pairs.append((key, case["perturb"], min(exponent["epsilon"], *exponent["epsilons"]), values))
    for key, perturb, epsilon, values in pairs:
        if "conveyor" in values:
            remedy = "give z0 a height in m, or perturb another parameter"
            yield f"{key}.perturb = {perturb!r} perturbs nothing where z0 is the word conveyor; {remedy}"
        elif any(abs(value + epsilon - value - epsilon) > 0.5 * epsilon for value in values):
            yield f"{key}.epsilon = {epsilon!r} is lost in the rounding of {perturb}; give a larger one"


def scans(config: dict) -> Iterator[str]:
    for name, entry in config["critical"].items():
        for part in ("axes", "model"):
            if "z0" in entry.get(part, ()):
                yield f"critical.{name}.{part}.z0 is what is scanned; give its values as critical.{name}.scan"
        largest = max(map(abs, ends(entry["scan"])))
        if entry["resolution"] <= 2.0 * math.ulp(largest):
            yield (
                f"critical.{name}.resolution = {entry['resolution']!r} m is below the distance of numbers in double "
                f"precision; take at least {4.0 * math.ulp(largest):g} m"
            )
    for name, entry in config["regressions"].items():
        if entry["critical"] not in config["critical"]:
            remedy = did_you_mean(entry["critical"], config["critical"])
            yield f"regressions.{name}.critical = {entry['critical']!r} is no entry of critical; {remedy}"


def sensitivity(config: dict) -> Iterator[str]:
    name = config["sensitivity"]["critical"]
    if name not in config["critical"]:
        remedy = did_you_mean(name, config["critical"])
        yield f"sensitivity.critical = {name!r} is no entry of critical; {remedy}"
        return
    entry = resolve(config, "critical", name)
    if set(entry["axes"]) != {"acceleration"} or entry["method"] != "event":
        yield (
            f"sensitivity.critical = {name!r} is not over the acceleration alone, or not by the method event; give "
            "another entry of critical"
        )


def times(config: dict) -> Iterator[str]:
    for name, entry in config["signals"].items():
        duration = resolve(config, "signals", name)["duration"]
        if entry["times"]["stop"] > duration:
            key = f"signals.{name}.times.stop = {entry['times']['stop']!r} s"
            yield f"{key} is beyond the duration of {duration!r} s; take less, or give signals.{name}.duration"
    for name, case in config["benchmark"]["cases"].items():
        duration = case.get("duration", config["solver"]["duration"])
        if case["compared"] > duration:
            yield f"benchmark.cases.{name}.compared = {case['compared']!r} s is beyond the duration of {duration!r} s"


def orbits(config: dict) -> Iterator[str]:
    low, high = config["orbits"]["limits"]
    for place, seed in enumerate(config["orbits"].get("seeds", [])):
        if not low < seed["acceleration"] < high:
            yield (
                f"orbits.limits = {[low, high]!r} m/s² must hold the amplitude of orbits.seeds[{place}], "
                f"{seed['acceleration']!r}, between them: its branch is followed to both sides"
            )


def dimensions(config: dict) -> Iterator[str]:
    for name, entry in config["dimensions"].items():
        needed = {"paper": "octaves", "correlation": "theiler"}.get(entry["estimator"])
        if needed and needed not in entry:
            yield f"dimensions.{name} lacks {needed}, which the estimator {entry['estimator']} needs"
        if entry.get("theiler", 0) >= entry["samples"]:
            yield f"dimensions.{name}.theiler = {entry['theiler']} leaves no pair of {entry['samples']} samples"


def sizes(config: dict) -> Iterator[str]:
    for name in config["sweeps"]:
        shared, limit = plan(config["sharing"], resolve(config, "sweeps", name)), config["sharing"]["core_hours"]
        if shared.core_hours > limit:
            yield (
                f"sweeps.{name}.axes makes {shared.points:,} points, some {shared.core_hours:.2g} hours of one core in "
                f"{shared.shards} jobs of {shared.memory / 1000.0:.2g} GB; give a smaller num, or raise "
                f"sharing.core_hours = {limit:g}"
            )
    for section in ENTRIES:
        for name, entry in config[section].items():
            if section == "sweeps" or "axes" not in entry:
                continue
            points = count_points(entry["axes"])
            rows = points * count_values(entry.get("times") or entry.get("scan") or [None])
            if rows > LARGEST_TABLE:
                yield (
                    f"{section}.{name}.axes makes {rows:,} points or rows; at most {LARGEST_TABLE:,} are computed, "
                    "some hours of a machine: give a smaller num"
                )
    operating = config["operating"]
    starts = count_values(operating["acceleration"]) * operating["starts"]
    if starts > LARGEST_TABLE:
        yield f"operating.starts makes {starts:,} points; at most {LARGEST_TABLE:,} are computed: give fewer"


def tables_of(config: dict) -> Iterator[str]:
    """References to tables that are none."""
    known = references(config)
    used = [
        (f"{user}.{name}.{key}.{role}", reference)
        for user in ("figures", "figures_on_request", "claims")
        for name, entry in config[user].items()
        for key in ("tables", "caption_tables")
        for role, reference in entry.get(key, {}).items()
    ]
    for key, reference in used:
        if reference not in known:
            yield f"{key} = {reference!r} is no entry of the config; {did_you_mean(reference, known)}"
    for reference in config["scene_budget"]["reasons"]:
        if reference not in known:
            yield f"scene_budget.reasons.{reference} is no table of the config; {did_you_mean(reference, known)}"


def asked(key: str, given: dict, known: set[str], needed: set[str], user: str) -> Iterator[str]:
    """Names that `user` does not ask for, and those that it asks for in vain."""
    for name in given:
        if name not in known:
            yield f"{key}.{name} is an unknown key: {user} does not use it; {did_you_mean(name, sorted(known))}"
    if missing := sorted(needed - given.keys()):
        yield f"{key} lacks {', '.join(missing)}, which {user} needs"


def figures(config: dict) -> Iterator[str]:
    listed = [(section, *one) for section in ("figures", "figures_on_request") for one in config[section].items()]
    for section, figure, entry in listed:
        files = [f"scripts/figures/plots/{figure}.py", f"workflow/report/{figure}.rst"]
        missing = [file for file in files if not (ROOT / file).is_file()]
        for file in missing:
            yield f"{section}.{figure} has no {file}; a figure needs a plot script and a caption of its name"
        for reference in entry["tables"].values():
            table = entry_of(config, reference)
            if table and entry["needs"] == "feeding" and table.get("needs") == "vertical":
                yield f"{section}.{figure} needs feeding, but {reference} is computed for vertical needs only"
        if missing:
            continue
        names, user = names_of_figure(figure, "tables"), f"scripts/figures/plots/{figure}.py"
        given = entry["tables"] | entry.get("caption_tables", {})
        known = {role for role in given if any(one.knows(role) for one in names)}
        needed = set().union(*(one.needed for one in names))
        for key in ("tables", "caption_tables"):
            yield from asked(f"{section}.{figure}.{key}", entry.get(key, {}), known | needed, set(), user)
        yield from asked(f"{section}.{figure}.tables", {}, known, needed - given.keys(), user)
        names, given = names_of_figure(figure, "settings"), entry.get("settings", {})
        known, needed = (set().union(*(getattr(one, kind) for one in names)) for kind in ("asked", "needed"))
        yield from asked(f"{section}.{figure}.settings", given, known, needed, user)
        yield from numbers_of_caption(figure)


def numbers_of_caption(figure: str) -> Iterator[str]:
    """What the caption of a figure asks for in vain; all are told whether they are about the paper's machine."""
    wanted, function = names_of_template(ROOT / f"workflow/report/{figure}.rst"), caption_functions().get(figure)
    given = names_asked("figures.captions", function, "tables") if function else None
    for name in sorted(name for name in wanted - {"paper"} if not (given and given.knows(name))):
        lacking = f"{function} does not give it" if function else f"NUMBERS has no function for {figure}"
        yield f"workflow/report/{figure}.rst asks for {name}, but in scripts/figures/captions.py {lacking}"


def claims(config: dict) -> Iterator[str]:
    for claim, entry in config["claims"].items():
        finding = entry["finding"]
        if finding not in findings():
            remedy = did_you_mean(finding, sorted(findings()))
            yield f"claims.{claim}.finding = {shown(finding)} is no function of scripts/claims; {remedy}"
            continue
        module = finding.split(".")[0]
        if module not in keys_of("claims.verdicts", "FINDINGS"):
            yield f"claims.{claim}.finding = {shown(finding)}: add {module} to FINDINGS in scripts/claims/verdicts.py"
        names = names_of_finding(finding)
        for key in ("tables", "quantities"):
            known = {name for name in entry[key] if names.knows(name)}
            needed = names.needed if key == "tables" else set()
            yield from asked(f"claims.{claim}.{key}", entry[key], known | needed, set(needed), finding)
        known, needed = map(set, settings_of_finding(finding))
        yield from asked(f"claims.{claim}.settings", entry.get("settings", {}), known, needed, finding)


def fixed_steps(config: dict) -> Iterator[str]:
    """Methods of fixed steps that are named and no more."""
    module, file = "conveyor.methods.fixed_step", "scripts/conveyor/methods/fixed_step.py"
    stepped, counted = compared(module, "integrate", "integrate_all"), len(LIBRARY["EVALUATIONS"])
    for place, method in enumerate(LIBRARY["METHODS"]):
        if method.upper() not in stepped:
            yield f"method {method}: {file} has no step for it; add one where `integrate` compares `method`"
        if place >= counted:
            yield f"method {method}: EVALUATIONS in {file} does not say how often it evaluates the forces; add it"
        if method not in LIBRARY["GROWTH"]:
            yield f"method {method}: GROWTH in {file} does not say how it multiplies a decay; add it, or None"
        if method not in keys_of("figures.style", "METHODS"):
            yield f"method {method}: METHODS in scripts/figures/style.py has no colour and no name for it; add them"


def companion(config: dict) -> Iterator[str]:
    own = config["companion"]
    for index, name in enumerate(own["maps"]):
        if name not in config["sweeps"]:
            remedy = did_you_mean(name, config["sweeps"])
            yield f"companion.maps[{index}] = {shown(name)} is no entry of sweeps; {remedy}"
    if own["opening"] not in own["presets"]:
        yield f"companion.opening = {shown(own['opening'])} is not one of {', '.join(own['presets'])}"


def identification(config: dict) -> Iterator[str]:
    own = config["identification"]
    searched = [number for group in own["objectives"].values() for number in group]
    for number in sorted({number for number in searched if searched.count(number) > 1}):
        yield f"identification.objectives has {number} in two of its groups; keep it in one of them"
    for name, evidence in own["evidence"].items():
        for number in evidence["without"]:
            if number not in searched:
                remedy = did_you_mean(number, searched)
                yield f"identification.evidence.{name}.without = {number!r} is in no objective; {remedy}"
        left = len(searched) - len(evidence["without"])
        if left <= len(own["bounds"]):
            yield f"identification.evidence.{name}.without leaves {left} numbers for {len(own['bounds'])} parameters"
    if own["search"]["population"] <= (weights := own["search"]["weights"] + 1) * (weights + 1) // 2:
        yield (
            f"identification.search.population = {own['search']['population']} holds no more than the triples of "
            f"weights, {weights * (weights + 1) // 2}; give more, or fewer weights"
        )


CHECKS = (
    overridden_axes,
    steps,
    perturbations,
    scans,
    sensitivity,
    times,
    orbits,
    dimensions,
    sizes,
    tables_of,
    figures,
    claims,
    fixed_steps,
    companion,
    identification,
)


def contradictions(config: dict) -> list[str]:
    """One line for each contradiction between parts of a config whose types are right."""
    return [line for check in CHECKS for line in check(config)]
