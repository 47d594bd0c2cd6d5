"""Fig. 18: the map of Fig. 13 at an amplitude at which chaos exists beside the first and the second state."""

from figures.plots.fig13 import plot

__all__ = ["plot"]
