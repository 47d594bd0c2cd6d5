"""Boundaries of basins of attraction over the initial height, and their fit by a hyperbola."""
