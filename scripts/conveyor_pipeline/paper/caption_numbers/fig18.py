"""Numbers of the caption of the figure fig18."""

from conveyor_pipeline.paper.caption_numbers.fig12 import numbers

__all__ = ["numbers"]
