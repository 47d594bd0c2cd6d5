"""Dynamics of a point mass on a vibratory conveyor: exact events, and the analysis of the motion."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .simulation import Run, simulate
    from .solver.model import Conveyor, Start

__all__ = ["Conveyor", "Run", "Start", "simulate"]
__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    """Import the public names on first use, so that `conveyor.parameters` can be imported without NumPy and Numba."""
    if name in ("Conveyor", "Start"):
        from .solver import model

        return getattr(model, name)
    if name in ("Run", "simulate"):
        from . import simulation

        return getattr(simulation, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
