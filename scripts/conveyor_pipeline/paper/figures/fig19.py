"""Fig. 19: the map of Fig. 14 at an amplitude at which the first state, the second state and chaos coexist."""

from conveyor_pipeline.paper.figures.fig14 import plot

__all__ = ["plot"]
