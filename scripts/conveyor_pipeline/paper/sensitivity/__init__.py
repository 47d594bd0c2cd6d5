"""Stage sensitivity: derivatives of bifurcations and critical heights, and bifurcation curves."""
