"""Limits of the stage motion that captions name. No slow imports, so that captions do not wait for the solver."""

RESOLUTION = 2e-6  # to which bisection locates a height, as a share of the scanned range: 1 nm of the range of Fig. 8
