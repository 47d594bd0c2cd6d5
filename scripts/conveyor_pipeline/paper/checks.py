"""Contradictions in the sections of the floor paper, as in config/checks.py."""

from collections.abc import Iterator

from conveyor_pipeline.common.axes import ends
from conveyor_pipeline.config.checks import faults_of_names
from conveyor_pipeline.config.entries import by_methods, resolve, values_of, variants
from conveyor_pipeline.paper.claims.statements import read_claims


def perturbations(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    for name, entry in config["estimates"].items():
        perturb, epsilon = entry["perturb"], entry["epsilon"]
        values = values_of(resolve(config, "estimates", name), perturb)
        if "conveyor" in values:
            remedy = f"give model.z0 or estimates.{name}.model.z0 a height in m, or perturb another parameter"
            yield f"estimates.{name}.perturb = {perturb!r} has no effect because z0 is the word conveyor; {remedy}"
        elif any(abs(value + epsilon - value - epsilon) > 0.5 * epsilon for value in values):
            yield f"estimates.{name}.epsilon = {epsilon!r} is lost in the rounding of {perturb}; give a larger one"


def critical(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    for name, entry in config["critical"].items():
        for part in ("axes", "model"):
            if "z0" in entry.get(part, ()):
                yield f"critical.{name}.{part}.z0 is the scanned parameter; give its values as critical.{name}.scan"
    name = config["sensitivity"]["critical"]
    single = by_methods(config)
    entry = resolve(single, "critical", name) if name in single["critical"] else None
    if entry and (set(entry["axes"]) != {"acceleration"} or entry["method"] != "event"):
        yield f"sensitivity.critical = {name!r} must name an entry over acceleration alone, with the method event"


def times(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    for name, entry in config["signals"].items():
        duration = resolve(config, "signals", name)["duration"]
        if entry["times"]["stop"] > duration:
            key = f"signals.{name}.times.stop = {entry['times']['stop']!r} s"
            yield f"{key} is beyond the duration of {duration!r} s; take less, or give signals.{name}.duration"


def orbits(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    low, high = config["orbits"]["limits"]
    for place, seed in enumerate(config["orbits"]["seeds"]):
        if not low < seed["acceleration"] < high:
            yield (
                f"orbits.limits = {[low, high]!r} m/s² must hold the amplitude of orbits.seeds[{place}], "
                f"{seed['acceleration']!r}, between them: its branch is followed to both sides"
            )


def regressions(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """Values of B at which the pole of Eq. 13, at the amplitude -B, lies between the fitted amplitudes."""
    for name, entry in config["regressions"].items():
        smallest, largest = entry["acceleration"]
        for key, (low, high) in (("bounds.B", entry["bounds"]["B"]), ("valley", ends(entry["valley"]))):
            if low + smallest <= 0.0 <= high + largest:
                yield (
                    f"regressions.{name}.{key} from {low!r} to {high!r} m/s² has a pole of Eq. 13 within "
                    f"regressions.{name}.acceleration; begin above {-smallest!r}, or end below {-largest!r}"
                )


def dimensions(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    for name, entry in config["dimensions"].items():
        methods = {variant.get("method", config["solver"]["method"]) for variant in variants(name, entry).values()}
        if entry["estimator"] != "paper" and methods != {"event"}:
            yield (
                f"dimensions.{name}.estimator = {entry['estimator']!r} follows the settled motion, which needs the "
                "method event; give that method, or the estimator paper"
            )


def unknown_names(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """Entries that the config does not have, and claims that the paper does not have."""
    fitted = by_methods(config)["critical"]
    used = [(f"regressions.{name}.critical", item["critical"], fitted) for name, item in config["regressions"].items()]
    used += [("sensitivity.critical", config["sensitivity"]["critical"], fitted)]
    named = enumerate(config["uncertainty"]["claims"])
    used += [(f"uncertainty.claims[{place}]", name, read_claims()) for place, name in named]
    yield from faults_of_names(used)


CHECKS = (perturbations, critical, times, orbits, regressions, dimensions, unknown_names)
