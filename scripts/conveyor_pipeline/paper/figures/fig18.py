"""Fig. 18: the map of Fig. 13 at an amplitude at which the first state, the second state and chaos coexist."""

from conveyor_pipeline.paper.figures.fig13 import plot

__all__ = ["plot"]
