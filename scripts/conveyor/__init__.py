"""Dynamics of a point mass on a vibratory conveyor: exact events, and the analysis of the motion."""

from typing import TYPE_CHECKING, Any

from .solver.model import Conveyor, Start

if TYPE_CHECKING:
    from .simulation import Run, simulate

__all__ = ["Conveyor", "Run", "Start", "simulate"]
__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    """`Run` and `simulate` when they are asked for: who only reads tables need not wait for a compiler to load."""
    if name in __all__:
        from . import simulation

        return getattr(simulation, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
