"""Boundaries of basins of attraction over the initial height."""
