"""The conveyor and the part: parameters with their units, and the excitation (Eqs. 1-12 and 15 of the paper).

The axis x runs along the track, which rises in the feeding direction by the inclination α, and z is normal to it. The
plate moves harmonically, along the track with a phase shift ε; the part is a point mass. With θ = ωt + ψ0 and ω = 2πf,

    z_s = -(a_z/ω²) cos θ,         ż_s = (a_z/ω) sin θ,         z̈_s = a_z cos θ,
    x_s = -(a_x/ω²) cos(θ + ε),    ẋ_s = (a_x/ω) sin(θ + ε),    ẍ_s = a_x cos(θ + ε).

Harmonics of the orders k may be added to both accelerations (see Harmonic), and their integrals to the others.

With the gap q = z_p - z_s, the contact force acts while q ≤ 0:

    F_c = k_c (-q)^p - d_c q̇,   m z̈_p = -m g cos α + F_c,   m ẍ_p = -m g sin α + μ F_c sign(ẋ_s - ẋ_p).

The part sticks while |ẍ_s + g sin α| ≤ μ_s F_c/m. The paper's conveyor has α = ε = 0 and μ_s = μ.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from operator import attrgetter
from typing import NamedTuple

import numpy as np

from ..arguments import check_choice, check_count, check_number, check_parameter
from ..parameters import HARMONIC, MOST_HARMONICS, PARAMETERS, RANGES, TENSION_MODES, UNITS
from .jit import compiled_inline

ACCELERATION, ANGLE, FREQUENCY, PSI0, STIFFNESS, DAMPING, FRICTION, MASS = range(8)
EXPONENT, GRAVITY, INCLINATION, PHASE_SHIFT, STATIC_FRICTION, TENSION, Z0, VZ0 = range(8, len(PARAMETERS))
# The parameters of a Conveyor that are numbers, in this order.
numbers_of = attrgetter(*PARAMETERS[:TENSION])
TENSION_ALLOW, TENSION_FRICTIONLESS, TENSION_CLIP = range(len(TENSION_MODES))


def check_static_friction(friction: float, static_friction: float) -> None:
    """ValueError if a part would start to slide at a lower coefficient than it slides with."""
    if static_friction < friction:
        remedy = "give at least the friction, or leave static_friction out"
        raise ValueError(f"static_friction = {static_friction!r} is below friction = {friction!r}; {remedy}")


class Harmonic(NamedTuple):
    """A harmonic of order k of the plate's acceleration, along the track and normal to it.

    They are â cos φ along cos(kθ + along_phase) and â sin φ normal cos(kθ + normal_phase), with θ = ωt + ψ0.
    """

    order: int
    along: float = 0.0
    along_phase: float = 0.0
    normal: float = 0.0
    normal_phase: float = 0.0


def check_harmonics(harmonics: Sequence[Harmonic | Mapping[str, float]]) -> tuple[Harmonic, ...]:
    """`harmonics` as Harmonics in ascending order; ValueError that names the number which cannot be used."""
    if not isinstance(harmonics, (list, tuple)):
        raise ValueError(f"harmonics = {harmonics!r} must be a list of harmonics")
    checked = []
    for k, harmonic in enumerate(harmonics):
        harmonic = harmonic._asdict() if isinstance(harmonic, Harmonic) else harmonic
        if not isinstance(harmonic, Mapping) or "order" not in harmonic or not harmonic.keys() <= HARMONIC.keys():
            raise ValueError(f"harmonics[{k}] = {harmonic!r} must have an order, and of {', '.join(HARMONIC)} only")
        for name, value in harmonic.items():
            _, unit, (low, high) = HARMONIC[name]
            check = check_count if name == "order" else partial(check_number, unit=unit)
            check(f"harmonics[{k}].{name}", value, low, high)
        checked.append(
            Harmonic(int(harmonic["order"]), *(float(harmonic.get(name, 0.0)) for name in Harmonic._fields[1:]))
        )
    orders = [harmonic.order for harmonic in checked]
    if len(set(orders)) < len(orders) or len(orders) > MOST_HARMONICS:
        raise ValueError(f"harmonics have the orders {orders}: at most {MOST_HARMONICS}, each once")
    return tuple(sorted(checked))


@dataclass(frozen=True, slots=True)
class Conveyor:
    """A vibrating plate, the part on it and their contact, in SI units. The defaults are the values of Sect. 3.

    Attributes
    ----------
    acceleration : excitation amplitude â, m/s²
    angle : angle of throw φ, rad
    frequency : excitation frequency f, Hz
    psi0 : phase of the excitation at t = 0, rad
    stiffness : contact stiffness k_c, N/m^p
    damping : contact damping d_c, N s/m
    friction : coefficient μ of sliding friction, 1
    mass : mass of the part, kg
    exponent : exponent p of the contact law, in [1, 3] (1 Hooke, 1.5 Hertz)
    gravity : gravitational acceleration g, m/s²
    inclination : angle α by which the track rises in the feeding direction, rad
    phase_shift : phase ε by which the plate's motion along the track leads its motion normal to it, rad
    static_friction : coefficient μ_s up to which the part sticks, at least `friction`; None if equal to it
    tension : treatment of a contact force that pulls, F_c < 0, because damping outweighs stiffness
        "allow" keeps Eqs. 7 and 11 as written, "frictionless" lets the contact pull without friction, and "clip" sets
        F_c = max(F_c, 0).
    harmonics : harmonics of the plate's motion, each a Harmonic or a mapping with some of its fields

    Raises
    ------
    ValueError
        names the parameter that is outside its range, or a static_friction below friction
    """

    acceleration: float = 40.0
    angle: float = math.radians(12.0)
    frequency: float = 50.0
    psi0: float = 0.0
    stiffness: float = 5e5
    damping: float = 0.3
    friction: float = 0.15
    mass: float = 0.7e-3
    exponent: float = 1.5
    gravity: float = 9.81
    inclination: float = 0.0
    phase_shift: float = 0.0
    static_friction: float | None = None
    tension: str = "allow"
    harmonics: Sequence[Harmonic | Mapping[str, float]] = ()

    def __post_init__(self):
        for name, value in zip(PARAMETERS, numbers_of(self), strict=False):
            if value is not None or name != "static_friction":
                check_parameter(name, value)
        if self.static_friction is not None:
            check_static_friction(self.friction, self.static_friction)
        check_choice("tension", self.tension, TENSION_MODES)
        object.__setattr__(self, "harmonics", check_harmonics(self.harmonics))


@dataclass(frozen=True, slots=True)
class Start:
    """Initial conditions of the part: height z (m, or "conveyor" to start on the plate, Eq. 15) and velocity vz (m/s).

    Time starts at 0, the horizontal position and velocity at zero. A part on the plate does not press on it yet, and so
    cannot stick; a z that is lower by (m g cos α/k_c)^(1/p) begins with the weight of the part on the contact.
    """

    z: float | str = 0.0
    vz: float = 0.0

    def __post_init__(self):
        if not isinstance(self.z, str) or self.z != "conveyor":
            check_number("z", self.z, *RANGES["z0"], UNITS["z0"])
        check_number("vz", self.vz, *RANGES["vz0"], UNITS["vz0"])


def pack_harmonics(harmonics: Sequence[Harmonic]) -> list[float]:
    """The numbers of harmonics in the parameter vector, see plate."""
    waves = []
    for order, along, along_phase, normal, normal_phase in harmonics:
        waves += [order, along * math.cos(along_phase), along * math.sin(along_phase)]
        waves += [normal * math.cos(normal_phase), normal * math.sin(normal_phase)]
    return waves


def pack(conveyor: Conveyor, start: Start) -> np.ndarray:
    """The parameter vector, float64: 16 numbers in the order of PARAMETERS, and 5 for each harmonic (see plate).

    z0 is NaN for a start on the conveyor, and static_friction a number in every case.
    """
    z0 = math.nan if start.z == "conveyor" else start.z
    *numbers, static_friction = numbers_of(conveyor)
    static_friction = conveyor.friction if static_friction is None else static_friction
    tension = TENSION_MODES.index(conveyor.tension)
    waves = pack_harmonics(conveyor.harmonics)
    return np.array([*numbers, static_friction, tension, z0, start.vz, *waves], dtype=np.float64)


def unpack(parameters: np.ndarray) -> tuple[Conveyor, Start]:
    """The inverse of `pack`, with a number for static_friction in every case, and phases of harmonics in [-π, π]."""
    *numbers, tension, z0, vz0 = (float(value) for value in parameters[: len(PARAMETERS)])
    harmonics = []
    for order, *waves in parameters[len(PARAMETERS) :].reshape(-1, len(HARMONIC)).tolist():
        polar = [(math.hypot(*wave), math.atan2(wave[1], wave[0])) for wave in (waves[:2], waves[2:])]
        harmonics.append(Harmonic(int(order), *polar[0], *polar[1]))
    conveyor = Conveyor(*numbers, TENSION_MODES[int(tension)], tuple(harmonics))
    return conveyor, Start("conveyor" if math.isnan(z0) else z0, vz0)


@compiled_inline
def normal_gravity(parameters):
    """Gravity normal to the track, g cos α (m/s²), of a parameter vector."""
    return parameters[GRAVITY] * math.cos(parameters[INCLINATION])
