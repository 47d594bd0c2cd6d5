"""The law of motion in dimensionless form; the conveyor's numbers are read as exact decimals.

With lengths in g/ω², velocities in g/ω and the phase φ of the excitation as time, penetration δ = w² and the quantity
Y = δ' + β δ of the stroboscopic map obey, in contact with dφ = w ds,

    dw/ds = (Y - β w²)/2,   dY/ds = w (1 + γ z̈(φ)) - κ w^(2p+1),   dφ/ds = w,

and in flight δ'' = 1 + γ z̈(φ), with γ = â sin(angle)/g, β = d_c/(m ω) and κ = (k_c/(m g)) (g/ω²)^p. Gravity g is its
component normal to the track. The plate's motion z(φ) is that of `solver.plate`, whose functions also take balls.
"""

import math
from typing import NamedTuple

from flint import arb

from ..solver.model import Conveyor
from ..solver.plate import Plate
from .balls import exactly

# The plate's motion normal to the track at γ = 1.
PLATE = Plate(omega=1, a_x=0, a_z=1, cos_shift=1, sin_shift=0, waves=None)

# Digits after the decimal point of an angle in degrees that is read as a decimal number of degrees.
DIGITS_OF_DEGREES = 9


class Law(NamedTuple):
    """A conveyor without its amplitude; the balls contain the exact numbers."""

    slope: arb  # γ per m/s² of the amplitude
    beta: arb
    kappa: arb
    twice_exponent: int  # 2p
    phase: arb  # ψ0, rad
    omega: arb  # 1/s
    length: arb  # g/ω², m
    speed: arb  # g/ω, m/s

    def gamma(self, acceleration: arb) -> arb:
        """The amplitude of the plate's acceleration over gravity."""
        return self.slope * acceleration


class Accuracy(NamedTuple):
    """Accuracy of the steps of a contact."""

    order: int  # of the Taylor series
    tolerance: float  # of the last terms of a series


class System(NamedTuple):
    """The vertical motion at the amplitudes of a ball."""

    law: Law
    gamma: arb  # amplitude of the plate's acceleration over gravity
    accuracy: Accuracy


def read_angle(angle: float) -> arb:
    """An angle in rad. A float that stands for a decimal number of degrees is read as this number × π/180."""
    degrees = round(math.degrees(angle), DIGITS_OF_DEGREES)
    if abs(math.radians(degrees) - angle) <= 2.0 * math.ulp(angle):
        return exactly(degrees) * arb.pi() / 180
    return exactly(angle)


def law_of(conveyor: Conveyor) -> Law:
    """The law of a conveyor; each of its floats stands for its shortest decimal.

    ValueError for harmonics, and for a treatment of tension or an exponent with which the equations are not polynomial
    in w.
    """
    if conveyor.harmonics:
        raise ValueError("certificates are for plates without harmonics")
    if conveyor.tension != "allow":
        raise ValueError(f"certificates are for tension = allow, not {conveyor.tension}")
    twice = round(2.0 * conveyor.exponent)
    if twice != 2.0 * conveyor.exponent:
        raise ValueError(f"certificates need an exponent that is half a whole number, not {conveyor.exponent}")
    omega = 2 * arb.pi() * exactly(conveyor.frequency)
    gravity, mass = exactly(conveyor.gravity) * read_angle(conveyor.inclination).cos(), exactly(conveyor.mass)
    length = gravity / omega**2
    return Law(
        slope=read_angle(conveyor.angle).sin() / gravity,
        beta=exactly(conveyor.damping) / (mass * omega),
        kappa=exactly(conveyor.stiffness) / (mass * gravity) * length ** (arb(twice) / 2),
        twice_exponent=twice,
        phase=read_angle(conveyor.psi0),
        omega=omega,
        length=length,
        speed=gravity / omega,
    )
