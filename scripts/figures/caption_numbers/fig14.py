"""Numbers of the caption of the figure fig14."""

from figures.caption_numbers.fig12 import numbers

__all__ = ["numbers"]
