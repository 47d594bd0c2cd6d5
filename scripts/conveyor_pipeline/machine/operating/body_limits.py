"""What parts as bodies are compared at, and the limits of two statements on them.

Imported by captions and figures: no slow imports.
"""

# Throw numbers of the curves: 32 to 90 m/s² on the paper's conveyor; and those of the map, with what points do there on
# the paper's conveyor (21, 40 and 80 m/s²; at 32 m/s², a third of the points jumps).
THROWS, AMPLITUDES = (0.678, 1.907), 12
MOTIONS = {"ride": 0.45, "coexist": 0.848, "chaos": 1.696}
TILT = 0.03  # rad, the largest size of initial angles
PARTS = 32
# The differences of riding parts have standard errors well below the limit of 2 % below.
OF_A_CELL = {"ride": 128, "coexist": 12, "chaos": 12}
# Points are cheap. Where they have two velocities, the median of few of them is that of one or the other by chance.
POINTS = 256
TRACK, LONGEST = 2000.0, 500.0  # g cos α/ω² and cycles: 0.2 m and 10 s on the paper's conveyor
TOLERANCE = 1e-7  # with which settled velocities are known to 1e-4
# Statements of ours, not of the paper, with limits that were set before the numbers were known: the medians of all
# shapes of the map differ from that of points by at most these shares, where points ride and in chaos.
STATEMENT = {"ride": 0.02, "chaos": 0.1}
RIGHT = 0.1  # largest difference with which the median of points counts as right
