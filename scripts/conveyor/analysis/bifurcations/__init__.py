"""Periodic orbits, their branches and bifurcations, in one parameter and in two."""
