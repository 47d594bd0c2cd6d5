"""Names, units and admissible ranges of all parameters, and the words that choose a model or a method.

This module imports nothing slow, so that a program can check its settings without loading NumPy and Numba.
"""

import math
from collections.abc import Mapping
from numbers import Real

DEFAULT_TOLERANCE = 3e-10  # relative error per Taylor step
DEFAULT_STEP = 5e-7  # s, Sect. 3 of the paper
LAST = 0.25  # share of the run over which the paper takes mean values (Sect. 3.1)
TENSION_MODES = ("allow", "frictionless", "clip")
# Compiled functions receive a conveyor and an initial condition as one vector of parameters, in this order.
DESCRIPTIONS = {
    "acceleration": "acceleration amplitude of the plate along the direction of vibration, â (peak value)",
    "angle": "angle of throw φ between the direction of vibration and the track",
    "frequency": "frequency of the excitation, f",
    "psi0": "phase of the excitation at t = 0",
    "stiffness": "contact stiffness k_c",
    "damping": "contact damping d_c",
    "friction": "coefficient μ of sliding friction",
    "mass": "mass of the part, m_p",
    "exponent": "exponent p of the contact law: 1 is Hooke, 1.5 is Hertz",
    "gravity": "gravitational acceleration g",
    "inclination": "inclination α of the track, which rises in the feeding direction",
    "phase_shift": "phase ε by which the plate's motion along the track leads its motion normal to the track",
    "static_friction": "coefficient μ_s up to which the part sticks, at least friction; absent: equal to friction",
    "tension": "treatment of a contact force that pulls (Eqs. 7 and 11)",
    "z0": "initial height above the plate's mean position; the word conveyor puts the part on the plate (Eq. 15)",
    "vz0": "initial velocity of the part normal to the track",
}
PARAMETERS = tuple(DESCRIPTIONS)

# The unit of each parameter, and the closed interval of its admissible values. The intervals reject impossible values
# and most angles in degrees, but not unusual conveyors. The tension is one of TENSION_MODES.
UNITS_AND_RANGES = {
    "acceleration": ("m/s²", (0.0, 1e4)),
    "angle": ("rad", (0.0, 0.5 * math.pi)),
    "frequency": ("Hz", (1e-2, 1e5)),
    "psi0": ("rad", (-4.0 * math.pi, 4.0 * math.pi)),
    "stiffness": ("N/m^p", (1.0, 1e15)),
    "damping": ("N s/m", (0.0, 1e6)),
    "friction": ("1", (0.0, 10.0)),
    "mass": ("kg", (1e-12, 1e6)),
    "exponent": ("1", (1.0, 3.0)),
    "gravity": ("m/s²", (1e-3, 1e3)),
    "inclination": ("rad", (-1.4, 1.4)),
    "phase_shift": ("rad", (-4.0 * math.pi, 4.0 * math.pi)),
    "static_friction": ("1", (0.0, 10.0)),
    "tension": ("", None),
    "z0": ("m", (-1.0, 10.0)),
    "vz0": ("m/s", (-100.0, 100.0)),
}
UNITS = {name: unit for name, (unit, _) in UNITS_AND_RANGES.items()}
RANGES = {name: interval for name, (_, interval) in UNITS_AND_RANGES.items() if interval is not None}

# A harmonic of the plate's motion: description, unit and admissible values of its numbers. The shares belong to the
# amplitudes of the fundamental's acceleration in the same direction.
HARMONIC = {
    "order": ("multiple k of the excitation frequency", "1", (2, 100)),
    "along": ("acceleration amplitude along the track, as a share of â cos φ", "1", (0.0, 10.0)),
    "along_phase": ("phase of the acceleration cos(kθ + along_phase)", "rad", (-4.0 * math.pi, 4.0 * math.pi)),
    "normal": ("acceleration amplitude normal to the track, as a share of â sin φ", "1", (0.0, 10.0)),
    "normal_phase": ("phase of the acceleration cos(kθ + normal_phase)", "rad", (-4.0 * math.pi, 4.0 * math.pi)),
}
HARMONICS = "harmonics of the plate's motion, which grow with its acceleration amplitude"
MOST_HARMONICS = 12

# Parameters of an initial condition; ψ0 only shifts the phase at which a motion is observed.
INITIAL_CONDITION = ("psi0", "z0", "vz0")
# Parameters that leave the motion normal to the track as it is.
TANGENTIAL = ("friction", "phase_shift", "static_friction")


def normal_gravity(model: Mapping[str, float]) -> float:
    """Gravity normal to the track, g cos α (m/s²); a model without an inclination has a level track.

    Examples
    --------
    >>> normal_gravity({"gravity": 9.81})
    9.81
    """
    return model["gravity"] * math.cos(model.get("inclination", 0.0))


def length_scale(model: Mapping[str, float]) -> float:
    """The unit of length of the motion normal to the track, g cos α/ω² (m)."""
    return normal_gravity(model) / (2.0 * math.pi * model["frequency"]) ** 2


def speed_scale(model: Mapping[str, float]) -> float:
    """The unit of velocity of the motion normal to the track, g cos α/ω (m/s)."""
    return normal_gravity(model) / (2.0 * math.pi * model["frequency"])


# Methods with a fixed step. The position of a name is its code in compiled functions.
FIXED_STEP_METHODS = ("euler", "semi_implicit_euler", "rk4")


def format_interval(low: float, high: float, unit: str = "", *, above: bool = False) -> str:
    """The admissible values of an argument, for its error; a number without dimension has the unit "1".

    Examples
    --------
    >>> format_interval(0.0, 10.0, "m", above=True), format_interval(0.0, 10.0, "1")
    ('(0, 10] m', '[0, 10]')
    """
    return f"{'(' if above else '['}{low:g}, {high:g}] {unit if unit != '1' else ''}".rstrip()


def check_number(name: str, value: object, low: float, high: float, unit: str = "", *, above: bool = False) -> float:
    """`value` as a float; it must lie in [low, high], or in (low, high] where it has to lie `above` the lower end.

    ValueError names the argument, its unit and its interval.

    Examples
    --------
    >>> check_number("radius", 2, 0.0, 10.0, "m", above=True)
    2.0
    """
    # A truth value and, to NumPy, a time span (of the kind "m") are whole numbers. Plain numbers come first, because an
    # abstract class takes so long to check that a short run would take twice its time.
    if isinstance(value, (float, int)):
        is_number = not isinstance(value, bool)
    else:
        is_number = isinstance(value, Real) and getattr(getattr(value, "dtype", None), "kind", "") != "m"
    try:
        number = float(value) if is_number else math.nan
    except OverflowError:
        number = math.nan
    if not low <= number <= high or (above and number == low):
        raise ValueError(f"{name} = {value!r} must be a number in {format_interval(low, high, unit, above=above)}")
    return number
