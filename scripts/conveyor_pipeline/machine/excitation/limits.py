"""Limits of the measured drive: when harmonics matter, a statement on them, and another frequency.

Imported by the Snakefile: no slow imports.
"""

MATTERS = 0.05  # relative change of the slowest 5 % or of the median
# A statement of ours, not of the paper, with limits that were set before the numbers were known: with this share of one
# harmonic, at any phase, the median in chaos changes by at most the one number, and the slowest 5 % of riding parts by
# at least the other.
STATEMENT = {"share": 0.05, "chaos": 0.05, "riding": 0.1}
OTHER_FREQUENCY = 0.01  # relative difference from a stated frequency: more than clocks differ, and than a motor slips
OTHER_DIRECTION = 0.1  # rad, difference from a stated angle of throw or phase shift: more than a mount is wrong by
