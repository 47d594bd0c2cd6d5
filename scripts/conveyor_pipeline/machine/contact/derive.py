"""Stiffness and damping of a contact from its materials and from a drop. Imported by the Snakefile: no slow imports."""

import math
from functools import cache
from types import SimpleNamespace
from typing import Any

from conveyor import damping_of, hertz_stiffness

HERTZ = 1.5  # exponent of a Hertz contact
DIGITS = 6  # of values that follow from others
NAMED = ("part", "lining")


def moduli_of(entry: str | dict) -> Any:
    """A material of the config as `hertz_stiffness` takes it."""
    return (entry["modulus"], entry["poisson"]) if isinstance(entry, dict) else entry


def drop_speed(config: dict) -> float:
    """Speed (m/s) at the end of the drop."""
    return math.sqrt(2.0 * config["model"]["gravity"] * config["contact"]["drop_height"])


def on_level_plate(model: dict, **values: float) -> SimpleNamespace:
    """The contact of a model for `damping_of` and `restitution`: drops are made on a level plate."""
    return SimpleNamespace(**{**model, "inclination": 0.0, **values})


@cache
def damping_from(restitution: float, speed: float, contact: tuple) -> float:
    return damping_of(restitution, speed, SimpleNamespace(**dict(contact)))


def rounded(value: float) -> float:
    """A derived value, so that the last digits of a processor do not rerun anything."""
    return float(f"{value:.{DIGITS}g}")


def contact_of(config: dict) -> dict[str, float]:
    """Stiffness (N/m^1.5) and damping (N s/m), as far as the section `contact` gives them.

    ValueError names the key that is missing or cannot be met.
    """
    section, model = config["contact"], config["model"]
    derived = {}
    keys = (*NAMED, "radius")
    stated = [name for name in keys if section.get(name) is not None]
    if missing := [name for name in keys if stated and name not in stated]:
        remedy = "give it in m" if missing[0] == "radius" else "name its material"
        raise ValueError(
            f"contact.{missing[0]} is missing; part, lining and radius give the stiffness together; {remedy}, or "
            f"remove {' and '.join(stated)}"
        )
    if stated:
        if model["exponent"] != HERTZ:
            remedy = "give model.stiffness in place of part, lining and radius"
            raise ValueError(
                f"contact.radius needs a Hertz contact, but model.exponent is {model['exponent']}; {remedy}"
            )
        try:
            stiffness = hertz_stiffness(*(moduli_of(section[name]) for name in NAMED), section["radius"])
        except ValueError as error:
            raise ValueError(f"contact.{error}") from None
        derived["stiffness"] = rounded(stiffness)
    if section.get("restitution") is not None:
        contact = vars(on_level_plate(model, **derived, damping=0.0, harmonics=()))
        try:
            damping = damping_from(section["restitution"], drop_speed(config), tuple(contact.items()))
        except ValueError as error:
            raise ValueError(f"contact.{error}; give a larger one") from None
        derived["damping"] = rounded(damping)
    return derived
