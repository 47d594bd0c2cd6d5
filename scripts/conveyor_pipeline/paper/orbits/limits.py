"""Limits of the stage orbits that captions name. No slow imports, so that captions do not wait for the solver."""

MOST_ORBITS = 30_000  # after which no further branch is followed: five times as many as the paper's conveyor has
SIGNIFICANT = 3.0  # standard errors from zero of an exponent whose sign is certain
