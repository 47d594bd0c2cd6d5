"""Materials with their elastic moduli, and the stiffness of a Hertz contact between two of them.

`materials.csv` has solids with their sources. Rubber and polyurethane have a Shore hardness in their name, such as
polyurethane_85A, from which a formula gives the modulus:

- Shore A (20 to 95): E = 0.0981 (56 + 7.62336 A)/(0.137505 (254 - 2.54 A)) MPa (Gent 1958, "On the relation between
  indentation hardness and Young's modulus");
- Shore D (30 to 75): log₁₀ E = 0.0235 (D + 50) - 0.6403 with E in MPa (Qi, Joyce and Boyce 2003, "Durometer hardness
  and the stress-strain behavior of elastomeric materials").

The two formulas, of which the second one with A in place of D + 50 holds for Shore A, too, differ by up to a factor of
1.9. In an impact of a millisecond, an elastomer is stiffer than under a durometer, which waits for seconds. So its
modulus is taken to lie between 1/1.5 and 3 times the value of the formula; this range is an assumption.

Nothing slow is imported, so that a program can convert materials before it loads NumPy and Numba.
"""

import csv
import math
import re
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from .parameters import RANGES, check_number

ELASTOMERS = ("rubber", "polyurethane")
HARDNESS = {"A": (20, 95), "D": (30, 75)}
SHORE = re.compile(rf"({'|'.join(ELASTOMERS)})_(\d\d)([AD])")
# Of an elastomer, over the modulus of the formula.
UNCERTAINTY = (1.0 / 1.5, 3.0)
INCOMPRESSIBLE = 0.5  # Poisson's ratio of elastomers
SOFTEST, STIFFEST = 1e4, 2e12  # Pa, of a foam, and above diamond; a modulus in GPa is below
LARGEST_RADIUS = 0.5  # m; a radius in millimetres is above


class Material(NamedTuple):
    """Elastic constants of a material: modulus (Pa), its range, Poisson's ratio, and where they come from."""

    name: str
    modulus: float
    low: float
    high: float
    poisson: float
    description: str
    source: str


@cache
def materials() -> dict[str, Material]:
    """The materials of materials.csv by name.

    Examples
    --------
    >>> materials()["steel"].modulus
    207000000000.0
    """
    with open(Path(__file__).with_name("materials.csv"), encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    numbers = ("modulus", "low", "high", "poisson")
    return {row["name"]: Material(**row | {name: float(row[name]) for name in numbers}) for row in rows}


def shore_modulus(hardness: float, scale: str) -> float:
    """Young's modulus (Pa) of an elastomer of a Shore hardness, of the scale "A" or "D", see above.

    Examples
    --------
    >>> round(shore_modulus(85, "A") / 1e6, 1), round(shore_modulus(60, "D") / 1e6)  # MPa
    (13.2, 88)
    """
    if scale == "A":
        return 1e6 * 0.0981 * (56.0 + 7.62336 * hardness) / (0.137505 * (254.0 - 2.54 * hardness))
    return 1e6 * 10.0 ** (0.0235 * (hardness + 50.0) - 0.6403)


def material(name: str) -> Material:
    """A material by its name, also an elastomer such as rubber_60A; ValueError for an unknown name.

    Examples
    --------
    >>> polyurethane = material("polyurethane_85A")
    >>> round(polyurethane.modulus / 1e6, 1), polyurethane.poisson  # MPa
    (13.2, 0.5)
    """
    is_text = isinstance(name, str)
    if is_text and name in materials():
        return materials()[name]
    found = SHORE.fullmatch(name) if is_text else None
    if not found:
        raise ValueError(f"name = {name!r} is not one of {', '.join(materials())}, or such as {ELASTOMERS[0]}_60A")
    hardness, scale = int(found[2]), found[3]
    softest, hardest = HARDNESS[scale]
    if not softest <= hardness <= hardest:
        raise ValueError(f"name = {name!r} must have a hardness Shore {scale} from {softest} to {hardest}")
    modulus = shore_modulus(hardness, scale)
    low, high = (factor * modulus for factor in UNCERTAINTY)
    source = "Gent (1958)" if scale == "A" else "Qi, Joyce and Boyce (2003)"
    return Material(name, modulus, low, high, INCOMPRESSIBLE, f"{found[1]} of {hardness} Shore {scale}", source)


def constants_of(name: str, chosen: Any) -> tuple[float, float]:
    """Modulus (Pa) and Poisson's ratio of a Material, its name, or a pair of numbers; ValueError for other values."""
    if isinstance(chosen, str):
        try:
            chosen = material(chosen)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from None
    if isinstance(chosen, Material):
        return chosen.modulus, chosen.poisson
    try:
        modulus, poisson = map(float, chosen)
    except (TypeError, ValueError):
        raise ValueError(f"{name} = {chosen!r} must be a material, or a modulus in Pa and Poisson's ratio") from None
    if not (SOFTEST <= modulus <= STIFFEST and -1.0 < poisson <= 0.5):
        limits = f"a modulus in [{SOFTEST:g}, {STIFFEST:g}] Pa and Poisson's ratio in (-1, 0.5]"
        raise ValueError(f"{name} = {chosen!r} must have {limits}")
    return modulus, poisson


def hertz_stiffness(part: Any, lining: Any, radius: float) -> float:
    """The stiffness k_c (N/m^1.5) of a sphere on a half-space (Hertz 1882): F = (4/3) E* √R δ^1.5.

    1/E* = (1 - ν₁²)/E₁ + (1 - ν₂²)/E₂. It holds for a smooth, round place of contact that is large compared with the
    contact's radius √(R δ), and for a lining much thicker than that. It does not hold for edges, rims and flat faces.

    Parameters
    ----------
    part, lining : a Material, the name of one, or its modulus (Pa) and Poisson's ratio
    radius : radius R of the part at the place of contact, above 0 and at most 0.5 m

    Examples
    --------
    >>> round(hertz_stiffness("steel", "polyurethane_85A", 1.5e-3) / 1e3)  # kN/m^1.5
    908
    >>> round(hertz_stiffness((210e9, 0.3), (13e6, 0.5), 1.5e-3) / 1e3)
    895
    """
    radius = check_number("radius", radius, 0.0, LARGEST_RADIUS, "m", above=True)
    pairs = [constants_of(name, chosen) for name, chosen in (("part", part), ("lining", lining))]
    compliance = sum((1.0 - poisson**2) / modulus for modulus, poisson in pairs)
    stiffness = 4.0 / 3.0 * math.sqrt(radius) / compliance
    low, high = RANGES["stiffness"]
    if not low <= stiffness <= high:
        raise ValueError(
            f"radius = {radius!r} m gives a stiffness of {stiffness:.3g} N/m^1.5, outside [{low:g}, {high:g}]; "
            "give another radius or material"
        )
    return stiffness
