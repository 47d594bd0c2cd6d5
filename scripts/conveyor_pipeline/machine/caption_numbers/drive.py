"""Numbers of the caption of the figure drive."""

from conveyor_pipeline.machine.operating.drive_page import summarize_search as numbers

__all__ = ["numbers"]
