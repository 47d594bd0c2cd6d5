"""Dynamics of a point mass on a vibratory conveyor: exact events, and the analysis of the motion."""

from .simulation import Run, simulate
from .solver.model import Conveyor, Start

__all__ = ["Conveyor", "Run", "Start", "simulate"]
__version__ = "0.1.0"
