"""Numbers of the caption of the figure operating."""

from operating.chart import summarize_shares as numbers

__all__ = ["numbers"]
