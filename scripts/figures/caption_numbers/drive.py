"""Numbers of the caption of the figure drive."""

from operating.drive_page import summarize_search as numbers

__all__ = ["numbers"]
