"""Limits of the stage dimensions that captions name. No slow imports, so that captions do not wait for the solver."""

LARGEST_ERROR = 0.1  # of a settled motion, half a 95 % interval; a less certain estimate is left out
