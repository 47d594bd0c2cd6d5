"""Limits of the stage sensitivity that captions name. No slow imports, so that captions do not wait for the solver."""

LONGEST_PERIOD = 1  # excitation cycles, of the folds, doublings and grazings; longer orbits have too many to show
MOST = 6  # bifurcations of each kind, those at the lowest amplitudes; the paper's conveyor has five
UNEVEN = "changes by +1 % and -1 % differ"  # the status of a point that is another one, or not smooth
