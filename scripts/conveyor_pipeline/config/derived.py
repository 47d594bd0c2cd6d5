"""Parameters of the model that follow from other sections, which stages declare as DERIVED.

Such a function takes a valid config and returns parameters by name; its ValueError is a line for the user.
"""

import math
from collections.abc import Iterator

from conveyor import UNITS
from conveyor_pipeline.config.stages import declared

DERIVED = declared("DERIVED")
SAME = 1e-3  # relative difference up to which a stated value agrees with the derived one, which is used


def with_derived(config: dict) -> dict:
    """A config whose model has all parameters that follow from other sections."""
    derived = {name: value for derive in DERIVED.values() for name, value in derive(config).items()}
    return {**config, "model": config["model"] | derived}


def origins_of(config: dict) -> dict[str, str]:
    """The section that each derived parameter of the model follows from."""
    return {name: section for section, derive in DERIVED.items() for name in derive(config)}


def is_given(name: str, config: dict, defaults: dict, stated: dict) -> bool:
    """Whether the user gives a parameter of the model, possibly its default."""
    return name in stated.get("model", {}) or config["model"][name] != defaults["model"][name]


def faults_of_derived(config: dict, defaults: dict, stated: dict) -> Iterator[str]:
    """Sections that cannot be met, and those that a stated parameter of the model contradicts; one line each."""
    for section, derive in DERIVED.items():
        try:
            derived = derive(config)
        except ValueError as error:
            yield str(error)
            continue
        for name, value in derived.items():
            model_value = config["model"][name]
            if is_given(name, config, defaults, stated) and not math.isclose(model_value, value, rel_tol=SAME):
                remedy = f"remove it, or what gives it in the section {section}"
                value = f"{value!r} {UNITS[name]}".replace("^p", f"^{config['model']['exponent']:g}")
                yield f"model.{name} = {model_value!r} contradicts the section {section}, which gives {value}; {remedy}"
