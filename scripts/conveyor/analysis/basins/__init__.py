"""First impacts of initial conditions, and how uncertain the boundaries of basins are."""
