"""Certificates: periodic orbits, bifurcations and chaos of the vertical motion, proved by interval arithmetic.

Every number is a ball of python-flint (Johansson 2017): a midpoint and a radius. The ball contains the exact value; its
radius includes all rounding errors. A statement that cannot be proved raises `Refused` with the reason. Floating-point
results only say where to look; no bound depends on them. Read the modules in this order:

    law            the conveyor in units g/ω², g/ω, 1/ω, with its numbers read as exact decimals
    balls          conversions with outward rounding
    roots          the first zero of a function: interval Newton
    flight         parabola and plate, in closed form
    taylor         one Taylor step of a contact with a proved remainder, and its derivative
    double_double  compiled candidates for enclosures of its coefficients; `taylor` proves them
    motion         the motion from one phase to another through flights and contacts, and its derivative
    newton         zeros of equations: Krawczyk's operator
    shooting       the equations of a periodic orbit
    orbit          a periodic orbit: existence, uniqueness, least period, Floquet multipliers, stability
    brackets       amplitudes between which an orbit folds or doubles its period
    excursion      a homoclinic excursion in floating point, along which a horseshoe may lie
    covering       topological horseshoes from covering relations
"""

from typing import Any

import lazy_loader

load, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> Any:
    try:
        return load(name)
    except ModuleNotFoundError as error:
        if error.name != "flint":
            raise
        message = (
            'certificates need python-flint; install it in the folder of this project by pip install ".[certificates]"'
        )
        raise ModuleNotFoundError(message, name=error.name) from None
