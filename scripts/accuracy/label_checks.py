"""Whether each start earns its own label: found together, in reverse order and one by one, labels are compared."""

import numpy as np

from accuracy.settling_times import starts
from conveyor.analysis.attractors import labels
from conveyor.analysis.attractors.search import find_attractors
from conveyor.solver.progress import bar
from pipeline import fields

TABLES = {
    "label_checks": (
        fields.number("acceleration", "m/s²", "amplitude of the excitation"),
        fields.count("starts", "random starts, heights and phases"),
        fields.count("chaotic", "those that are called chaos"),
        fields.count("reversed", "starts whose state or period is another one in reverse order"),
        fields.count("alone", "starts whose state or period is another one if they are looked at one by one"),
        fields.count(
            "unshared_starts", "starts that were looked at without the attractors of their conveyor found before"
        ),
        fields.count("unshared", "those of them whose state or period is another one then"),
    ),
}


def different(found: labels.Labels, other: labels.Labels) -> int:
    """Number of starts whose state or period differ."""
    return int(np.count_nonzero((found.state != other.state) | (found.period != other.period)))


def together(parts: list[labels.Labels]) -> labels.Labels:
    """Labels of several starts below each other."""
    return labels.Labels(*map(np.concatenate, zip(*parts, strict=True)))


def row(acceleration: float, settings: dict, model: dict, options: dict) -> dict:
    """The comparison at one amplitude (m/s²)."""
    rows = starts(acceleration, settings, model)
    known = find_attractors(rows, **options)
    found = labels.classify(rows, known=known, **options)
    backwards = labels.classify(rows[::-1], known=known, **options)
    alone = [labels.classify(rows[k : k + 1], known=known, **options) for k in range(len(rows))]
    few = slice(0, settings["unshared"])
    return {
        "acceleration": acceleration,
        "starts": len(rows),
        "chaotic": int(np.count_nonzero(found.state == "chaos")),
        "reversed": different(found, labels.Labels(*(column[::-1] for column in backwards))),
        "alone": different(found, together(alone)),
        "unshared_starts": len(rows[few]),
        "unshared": different(labels.Labels(*(column[few] for column in found)), labels.classify(rows[few], **options)),
    }


def make(settings: dict, *, threads: int = 1, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table of comparisons, from the section of the config with model and tolerance."""
    options = {"cycles": settings["settling"], "tolerance": settings["tolerance"], "threads": threads}
    rows = [
        row(acceleration, settings, settings["model"], options)
        for acceleration in bar(settings["acceleration"], label=progress, unit="amplitudes")
    ]
    return {name: np.array([one[name] for one in rows]) for name in rows[0]}
