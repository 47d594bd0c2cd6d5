"""Stage sensitivity: changes of bifurcations and critical heights, and bifurcation curves."""
