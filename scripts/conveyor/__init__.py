"""Dynamics of a point mass on a vibratory conveyor: exact events, and the analysis of the motion."""

from .model import Conveyor, Start
from .simulation import Run, simulate

__all__ = ["Conveyor", "Run", "Start", "simulate"]
