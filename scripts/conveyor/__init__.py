"""Dynamics of a point mass on a vibratory conveyor: exact events, and the analysis of the motion.

`README.md` beside this file says how the library works and what to read first.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .interface import (
        basin,
        box_dimension,
        classify,
        continue_orbit,
        correlation_dimension,
        lyapunov_spectrum,
        periodic_orbit,
        sweep,
    )
    from .simulation import Run, simulate
    from .solver.model import Conveyor, Start

__all__ = [
    "Conveyor",
    "Run",
    "Start",
    "basin",
    "box_dimension",
    "classify",
    "continue_orbit",
    "correlation_dimension",
    "lyapunov_spectrum",
    "periodic_orbit",
    "simulate",
    "sweep",
]
__version__ = "1.0.0"

_MODULES = {"Conveyor": ".solver.model", "Start": ".solver.model", "Run": ".simulation", "simulate": ".simulation"}


def __getattr__(name: str) -> Any:
    """Import the public names on first use, so that `conveyor.parameters` can be imported without NumPy and Numba."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_MODULES.get(name, ".interface"), __name__), name)
