"""Numbers of the caption of the figure basin_stability."""

from conveyor_pipeline.machine.operating.regimes import summarize_shares as numbers

__all__ = ["numbers"]
