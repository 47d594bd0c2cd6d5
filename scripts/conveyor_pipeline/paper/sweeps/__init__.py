"""Stage sweeps: one trajectory for each point of a product of axes, and the state that it leads to."""
