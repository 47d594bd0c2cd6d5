"""Contradictions between the values of a config: one line each, with the key and the remedy.

Each check takes a config of the right types with one method per entry, and the default config.
"""

import math
import re
from collections.abc import Iterator
from functools import cache

from .errors import suggest_name, type_problems
from .files import DEFAULT_FILES, ROOT, merge, read_all
from .machine import is_own_machine
from .model import MODEL
from .sharing import plan
from .tables import (
    ENTRIES,
    METHOD_SECTIONS,
    TABLES,
    TIGHTENED,
    by_methods,
    count_points,
    count_values,
    ends,
    entry_of,
    references,
    resolve,
    values_of,
    with_tighter,
)

# Folders below results/ and figures/ that a prefix would share with the default config.
RESERVED = {*ENTRIES, *TABLES, "precision", "precision_times", "article", "benchmarks", "captions", "claims", "docs"}
RESERVED |= {"logs", "report", "runs", "sections", "shards", "site", "site_pages", "archive", "checks"}
LARGEST_TABLE = 10_000_000  # rows or states of one job, which takes some hours
MOST_STEPS = 10**9  # of one run with a fixed step, which takes some ten seconds
STEPS_IN_A_CYCLE = 20  # smallest number of steps that resolves an excitation cycle


def whole_steps(duration: float, step: float) -> bool:
    """Whether a duration (s) is a whole number of steps (s), up to the rounding of both."""
    count = round(duration / step)
    return count > 0 and abs(duration / step - count) <= 1e-9 * count


def step_error(step: float, duration: float, frequency: float) -> str | None:
    """The fault of a time step (s) of a run (s) at a frequency (Hz) with its remedy, or None."""
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
    for section in (*METHOD_SECTIONS, "dimensions"):
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
                yield f"critical.{name}.{part}.z0 is the scanned parameter; give its values as critical.{name}.scan"
        spacing = math.ulp(max(map(abs, ends(entry["scan"]))))
        if entry["resolution"] <= 2.0 * spacing:
            key = f"critical.{name}.resolution = {entry['resolution']!r} m"
            yield f"{key} is below the spacing of floating-point numbers; take at least {4.0 * spacing:g} m"


def sensitivity(config: dict) -> Iterator[str]:
    name = config["sensitivity"]["critical"]
    entry = resolve(config, "critical", name) if name in config["critical"] else None
    if entry and (set(entry["axes"]) != {"acceleration"} or entry["method"] != "event"):
        yield f"sensitivity.critical = {name!r} is not over the acceleration alone, by the method event; name another"


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
                    f"{section}.{name}.axes makes {rows:,} points or rows; at most {LARGEST_TABLE:,} are computed; "
                    "give a smaller num"
                )
    operating = config["operating"]
    starts = count_values(operating["acceleration"]) * operating["starts"]
    if starts > LARGEST_TABLE:
        yield f"operating.starts makes {starts:,} points; at most {LARGEST_TABLE:,} are computed: give fewer"


def unknown_references(config: dict) -> Iterator[str]:
    """Names of tables, entries and presets that the config does not have."""
    tables, critical, companion = references(config), config["critical"], config["companion"]
    used = [
        (f"{user}.{name}.{key}.{role}", table, tables)
        for user in ("figures", "figures_on_request", "claims")
        for name, entry in config[user].items()
        for key in ("tables", "caption_tables")
        for role, table in entry.get(key, {}).items()
    ]
    used += [("scene_budget.reasons", table, tables) for table in config["scene_budget"]["reasons"]]
    used += [(f"regressions.{name}.critical", one["critical"], critical) for name, one in config["regressions"].items()]
    used += [("sensitivity.critical", config["sensitivity"]["critical"], critical)]
    used += [(f"companion.maps[{place}]", name, config["sweeps"]) for place, name in enumerate(companion["maps"])]
    used += [("companion.opening", companion["opening"], companion["presets"])]
    used += [("uncertainty.claims", name, config["claims"]) for name in config["uncertainty"]["claims"]]
    for key, name, known in used:
        if name not in known:
            yield f"{key} = {name!r} is unknown; {suggest_name(name, known)}"


def figures(config: dict) -> Iterator[str]:
    for section in ("figures", "figures_on_request"):
        for figure, entry in config[section].items():
            for file in (f"scripts/figures/plots/{figure}.py", f"workflow/report/{figure}.rst"):
                if not (ROOT / file).is_file():
                    yield f"{section}.{figure} has no {file}; a figure needs a plot script and a caption of its name"
            for reference in entry["tables"].values():
                table = entry_of(config, reference)
                if table and entry["needs"] == "feeding" and table.get("needs") == "vertical":
                    yield f"{section}.{figure} needs feeding, but {reference} is computed for vertical needs only"


def compare_keys(key: str, given: dict, default: dict, may_lack: bool) -> Iterator[str]:
    """Keys of a mapping that the default config does not have there, and keys that are missing."""
    for name in (name for name in given if name not in default):
        yield f"{key}.{name} is an unknown key; {suggest_name(name, default)}"
    if not may_lack and (missing := [name for name in default if name not in given]):
        yield f"{key} lacks {', '.join(missing)}"


def unused_keys(config: dict, defaults: dict) -> Iterator[str]:
    """Tables and settings that the default config does not have: no plot script and no finding uses them."""
    may_lack = is_own_machine(defaults, config)
    for section in ("figures", "figures_on_request"):
        for name, entry in config[section].items():
            default = defaults[section].get(name)
            for key in ("tables", "caption_tables", "settings") if default else ():
                yield from compare_keys(f"{section}.{name}.{key}", entry.get(key, {}), default.get(key, {}), may_lack)
    by_finding = {claim["finding"]: claim for claim in defaults["claims"].values()}
    for name, entry in config["claims"].items():
        if entry["finding"] not in by_finding:
            remedy = suggest_name(entry["finding"], by_finding)
            yield f"claims.{name}.finding = {entry['finding']!r} is no finding of the default config; {remedy}"
            continue
        default = defaults["claims"].get(name, {})
        if default.get("finding") != entry["finding"]:
            default = by_finding[entry["finding"]]
        for key in ("tables", "quantities", "settings"):
            yield from compare_keys(f"claims.{name}.{key}", entry.get(key, {}), default.get(key, {}), may_lack)


def clashes(config: dict) -> Iterator[str]:
    """Entries that make the same table. The config still has `methods`."""
    for section in METHOD_SECTIONS:
        makers = {}
        for name, entry in config[section].items():
            for table in (name, *(f"{name}_{method}" for method in entry.get("methods", ())[1:])):
                if table in makers:
                    other = f"{section}.{makers[table]}"
                    yield f"{section}.{name} and {other} both make the table {section}/{table}; rename one of them"
                makers[table] = name


def tighter_clashes(config: dict) -> Iterator[str]:
    """Entries with the name of a table of tighter tolerances. The config has no other errors."""
    tightened = with_tighter(config)
    for section in TIGHTENED:
        for name, entry in config[section].items():
            if tightened[section][name] != entry:
                yield f"{section}.{name} has the name of a table of tighter tolerances (uncertainty.claims); rename it"


def methods(config: dict, defaults: dict) -> Iterator[str]:
    """Settings of methods that exclude each other. The config still has `methods`."""
    for section in (*METHOD_SECTIONS, "dimensions"):
        for name, entry in config[section].items():
            used = entry.get("methods") or [entry.get("method")]
            if "method" in entry and "methods" in entry:
                yield f"{section}.{name} has both method and methods; give methods: [{entry['method']}] alone"
            elif "step" in entry and used == ["event"] and "step" not in defaults[section].get(name, {}):
                yield f"{section}.{name}.step is not used by the method event; remove it, or give a fixed-step method"


def prefix(config: dict) -> Iterator[str]:
    if config["prefix"] in RESERVED:
        yield f"prefix = {config['prefix']!r} is a folder of the default results; give another name"


def identification(config: dict) -> Iterator[str]:
    own = config["identification"]
    searched = [number for group in own["objectives"].values() for number in group]
    for number in sorted({number for number in searched if searched.count(number) > 1}):
        yield f"identification.objectives has {number} in two of its groups; keep it in one of them"
    for name, evidence in own["evidence"].items():
        for number in evidence["without"]:
            if number not in searched:
                remedy = suggest_name(number, searched)
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
    prefix,
    overridden_axes,
    steps,
    perturbations,
    scans,
    sensitivity,
    times,
    orbits,
    dimensions,
    sizes,
    unknown_references,
    figures,
    identification,
)


@cache
def default_config() -> dict:
    return merge(*read_all(DEFAULT_FILES))


def contradictions(config: dict, defaults: dict) -> Iterator[str]:
    """One line for each contradiction between values of a config whose types are right."""
    yield from methods(config, defaults)
    yield from clashes(config)
    yield from unused_keys(config, defaults)
    # Lines about the tables of `methods` name the entry in the file.
    entries = {
        f"{section}.{name}_{method}": f"{section}.{name}"
        for section in METHOD_SECTIONS
        for name, entry in config[section].items()
        for method in entry.get("methods", [])[1:]
    }
    single = by_methods(config)
    for line in (line for check in CHECKS for line in check(single)):
        for table, entry in entries.items():
            line = re.sub(rf"(?<![\w.]){re.escape(table)}(?=\.)", entry, line)
        yield line


def problems(config: dict, defaults: dict | None = None) -> list[str]:
    """All errors of a merged config, one line each; empty if there are none."""
    if errors := type_problems(config):
        return errors
    typed = MODEL.validate_python(config)
    lines = contradictions(typed, default_config() if defaults is None else defaults)
    return list(dict.fromkeys(lines)) or list(tighter_clashes(by_methods(typed)))
