"""Fig. 19: the map of Fig. 14 at an amplitude at which chaos exists beside the first and the second state."""

from figures.plots.fig14 import plot

__all__ = ["plot"]
