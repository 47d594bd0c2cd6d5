"""Contradictions between the values of a config: one line each, with the key and the remedy.

Each check takes a config of the right types, the default config, and what the user states. Checks of one floor are in
FLOOR/checks.py. Imported by the Snakefile: no slow imports.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from importlib import import_module

from conveyor_pipeline.common.axes import count_points, count_values, ends
from conveyor_pipeline.common.quantities import STIFFNESS, exponent_of, is_quantity
from conveyor_pipeline.config.derived import faults_of_derived, is_given, with_derived
from conveyor_pipeline.config.entries import (
    ENTRIES,
    FIGURES,
    MEASURED_FILES,
    METHOD_SECTIONS,
    by_methods,
    count_shards,
    fill_defaults,
    values_of,
    variants,
)
from conveyor_pipeline.config.errors import format_key, suggest_name, type_problems
from conveyor_pipeline.config.files import DEFAULT_FILES, merge, read, walk
from conveyor_pipeline.config.model import MODEL, is_same_model
from conveyor_pipeline.config.scales import faults_of_scales, section_at, to_si
from conveyor_pipeline.config.schema import schema_at, unit_of
from conveyor_pipeline.config.stages import FLOORS
from conveyor_pipeline.config.tables import NAMED, TABLES, entry_of, references, references_of
from conveyor_pipeline.figures.titles import caption_file, package_of

# Folders below results/ and figures/ that a prefix would share with the default config.
RESERVED = {*NAMED, *(table.split("/")[0] for table in TABLES), "article", "benchmarks", "captions"}
RESERVED |= {"checks", "claims", "docs", "logs", "runs", "sections", "shards", "site", "site_pages"}
LARGEST_TABLE = 10_000_000  # rows or states of one job, which takes some hours
MOST_SHARDS = 1000  # jobs of one sweep: Snakemake takes minutes to plan more
MOST_STEPS = 10**9  # of one run with a fixed step, which takes some ten seconds
STEPS_IN_A_CYCLE = 20  # smallest number of steps that resolves an excitation cycle


def prefix(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    if config["prefix"].lower() in RESERVED:  # macOS does not distinguish Logs from logs
        yield f"prefix = {config['prefix']!r} is a folder of the default results; give another name"
    if not config["prefix"] and (changed := next(other_models(config, defaults), None)):
        yield (
            f"{changed} differs from the paper's model, whose results have no prefix; give the config one, such as "
            "prefix: mine"
        )


def other_models(config: dict, defaults: dict) -> Iterator[str]:
    """The first difference of each section or entry of the paper whose model is not the paper's, as KEY = VALUE."""
    entries = [(section, name) for section in ENTRIES for name in defaults[section]]
    for path in [(), *entries, ("orbits",), ("attractors",)]:
        model, paper = (whole["model"] | section_at(whole, path).get("model", {}) for whole in (config, defaults))
        if not is_same_model(model, paper):
            name = next(name for name, value in model.items() if name not in paper or value != paper[name])
            yield f"{format_key((*path, 'model', name))} = {model[name]!r}"


def measured_files(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    for section, key in MEASURED_FILES.items():
        path = config[section].get(key, "")
        if path and not config["prefix"]:
            yield f"{section}.{key} needs a folder for its results; give the config a prefix"
        if set("{}") & set(path):
            remedy = "rename the file or folder"
            yield f"{section}.{key} = {path!r} has braces, which Snakemake takes for a wildcard; {remedy}"


def methods(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """Settings of methods that exclude each other, and entries that make the same table."""
    for section in METHOD_SECTIONS:
        for name, entry in config[section].items():
            used = entry.get("methods") or [entry.get("method", config["solver"]["method"])]
            if "method" in entry and "methods" in entry:
                yield f"{section}.{name} has both method and methods; give methods: [{entry['method']}] alone"
            elif "step" in entry and used == ["event"] and "step" not in defaults[section].get(name, {}):
                yield f"{section}.{name}.step is not used by the method event; remove it, or give a fixed-step method"
        made = Counter(table for name, entry in config[section].items() for table in variants(name, entry))
        for table in (table for table, count in made.items() if count > 1):
            yield f"{section}.{table} is the name of two tables, one of them made by `methods`; rename an entry"


def axes(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    for section in ENTRIES:
        for name, entry in config[section].items():
            axes = set(entry.get("axes", ()))
            for axis in sorted(axes & set(entry.get("model", ()))):
                yield f"{section}.{name}.model.{axis} is an axis of this entry too; keep one of them"
            for axis in sorted(axes - set(defaults[section].get(name, entry).get("axes", ()))):
                yield (
                    f"{section}.{name}.axes.{axis} is no axis of this entry of the defaults, whose figures and claims "
                    "would mix its values; give the entry a name of your own"
                )
            if section != "sweeps" and "axes" in entry:
                rows = count_points(entry["axes"]) * count_values(entry.get("times") or entry.get("scan") or [None])
                if rows > LARGEST_TABLE:
                    limit = f"at most {LARGEST_TABLE:,} are computed; give a smaller num"
                    yield f"{section}.{name}.axes makes {rows:,} points or rows; {limit}"


def friction(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """Static friction below sliding friction, in the model and in all models that change one of them."""
    changed = {"model": config["model"]}
    for section in ENTRIES:
        for name, entry in config[section].items():
            axes = {key: ends(axis) for key, axis in entry.get("axes", {}).items()}
            changed[f"{section}.{name}"] = entry.get("model", {}) | axes
    changed |= {f"{section}.model": config[section].get("model", {}) for section in ("orbits", "attractors")}
    yield from faults_of_friction(config, changed)


def faults_of_friction(config: dict, changed: dict[str, dict]) -> Iterator[str]:
    """Static friction below sliding friction in models; `changed` are their differences from the config's, by key."""
    for key, differences in changed.items():
        model = config["model"] | differences
        if "static_friction" in model and differences.keys() & {"friction", "static_friction"}:
            values = (model[name] for name in ("friction", "static_friction"))
            sliding, static = (value if isinstance(value, list) else [value] for value in values)
            if min(static) < max(sliding):
                yield (
                    f"{key} has static_friction = {min(static)!r} below friction = {max(sliding)!r}; give a larger "
                    "static_friction, or leave it out to make both equal, or give a smaller friction"
                )


def exponent(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """Another exponent with the default stiffness, whose number has another unit then."""
    exponent = config["model"]["exponent"]
    is_other = config["prefix"] and exponent != defaults["model"]["exponent"]
    if is_other and not is_given("stiffness", config, defaults, stated):
        unit = f"N/m^{exponent:g}".removesuffix("^1")
        yield f"model.exponent = {exponent!r} changes the unit of model.stiffness; state model.stiffness in {unit} too"


def faults_of_stiffness(config: dict, typed: dict) -> Iterator[str]:
    """Units of stiffness, N/m^p, whose exponent p is not the exponent of the model; `typed` is the validated config."""
    for path, text in walk(config):
        if isinstance(text, str) and is_quantity(text) and unit_of(schema_at(path)) == STIFFNESS:
            entry = typed[path[0]].get(path[1], {}) if path[0] in ENTRIES else {}
            model = typed["model"] | entry.get("model", {})
            exponents = ends(entry.get("axes", {}).get("exponent", [model["exponent"]]))
            if any(exponent != exponent_of(text) for exponent in exponents):
                needed = " and ".join(f"N/m^{exponent:g}" for exponent in exponents)
                yield f"{format_key(path)} = {text!r} is not in the unit of the contact law; give it in {needed}"


def sweeps(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    rows = config["sharing"]["rows"]
    for name, entry in config["sweeps"].items():
        points, shards = count_points(entry["axes"]), count_shards(config, entry)
        if shards > MOST_SHARDS:
            yield (
                f"sweeps.{name}.axes makes {points:,} rows in {shards:,} jobs; at most {MOST_SHARDS:,} are allowed: "
                f"give a smaller num, or raise sharing.rows = {rows}"
            )


def steps(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    for section in METHOD_SECTIONS:
        for name, entry in config[section].items():
            key = f"{section}.{name}.step" if "step" in entry else f"solver.step (of {section}.{name})"
            for variant in variants(name, entry).values():
                filled = fill_defaults(config, section, variant)
                for frequency in values_of(filled, "frequency") if "step" in filled else ():
                    yield from faults_of_step(key, filled["step"], filled["duration"], frequency)


def faults_of_step(key: str, step: float, duration: float, frequency: float) -> Iterator[str]:
    shown = f"{key} = {step!r} s"
    largest = 1.0 / (STEPS_IN_A_CYCLE * frequency)
    whole = max(1, round(duration / step))
    if step > largest * (1.0 + 1e-9):
        yield f"{shown} is too long for {frequency:g} Hz; take at most {largest:g} s, 1/{STEPS_IN_A_CYCLE} of a cycle"
    elif duration / step > MOST_STEPS:
        shortest = f"{duration / MOST_STEPS:g} s"
        yield f"{shown} makes {duration / step:.0e} steps of {duration!r} s; take at least {shortest}"
    elif abs(duration / step - whole) > 1e-9 * whole:
        remedy = f"take {duration / whole:.12g}, or another duration"
        yield f"{shown} does not divide its duration of {duration:.10g} s; {remedy}"


def known_tables(config: dict, defaults: dict) -> list[str]:
    """The tables of a config, and those that are no entry but that the default config reads."""
    read = [reference for section in FIGURES for reference in references_of(defaults[section])]
    return [*references(by_methods(config)), *(name for name in read if name.split("/")[0] not in NAMED)]


def faults_of_names(used: Iterable[tuple[str, str, Iterable[str]]]) -> Iterator[str]:
    """Unknown names; `used` has the key, the name, and the known names."""
    for key, name, known in used:
        if name not in known:
            yield f"{key} = {name!r} is unknown; {suggest_name(name, known)}"


def figures(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """Figures without files, tables that the config does not have, and tables and settings that no plot script uses."""
    tables, entries = known_tables(config, defaults), by_methods(config)
    for section in FIGURES:
        for figure, entry in config[section].items():
            key = f"{section}.{figure}"
            if not (package_of(figure) and caption_file(figure)):
                files = f"scripts/conveyor_pipeline/FLOOR/figures/{figure}.py and {figure}.rst"
                yield f"{key} has no files {files}; a figure needs a plot script and a caption of its name"
            for reference in entry["tables"].values():
                if entry["needs"] == "feeding" and entry_of(entries, reference).get("needs") == "vertical":
                    yield f"{key} needs feeding, but {reference} has needs: vertical; remove it there"
            for part in ("tables", "caption_tables"):
                used = entry.get(part, {}).items()
                yield from faults_of_names((f"{key}.{part}.{role}", table, tables) for role, table in used)
            for part in ("tables", "caption_tables", "settings", "marks"):
                known = defaults[section].get(figure, entry).get(part, {})
                for name in entry.get(part, {}):
                    if name not in known:
                        yield f"{key}.{part}.{name} is an unknown key; {suggest_name(name, known)}"


CHECKS = (prefix, measured_files, methods, axes, friction, exponent, sweeps, steps, figures)


@cache
def all_checks() -> list[Callable[[dict, dict, dict], Iterator[str]]]:
    """The checks above, and those of each floor. Their modules import this one."""
    floors = [import_module(f"conveyor_pipeline.{floor}.checks") for floor in (*FLOORS, "pages")]
    return [*CHECKS, *(check for floor in floors for check in floor.CHECKS)]


@cache
def default_config() -> dict:
    return merge(*map(read, DEFAULT_FILES))


def problems(config: dict, defaults: dict | None = None, stated: dict | None = None) -> list[str]:
    """All errors of a merged config, one line each; empty if there are none.

    stated : what overlays and command line state, also if it is the default
    """
    if errors := type_problems(config):
        return errors
    typed = MODEL.validate_python(config)
    defaults = default_config() if defaults is None else defaults
    if faults := [*faults_of_stiffness(config, typed), *faults_of_scales(typed, defaults)]:
        return faults
    # Converted values have the limits of their SI units, and a partial axis has what the default gives.
    if errors := type_problems(typed := to_si(typed)):
        return [f"{error}; SI units follow from model.frequency and model.angle: are they right?" for error in errors]
    if faults := list(faults_of_derived(typed, defaults, stated or {})):
        return faults
    typed = with_derived(typed)
    return list(dict.fromkeys(line for check in all_checks() for line in check(typed, defaults, stated or {})))
