"""Dimensions of attractors: box counting and the correlation sum."""
