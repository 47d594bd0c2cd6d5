"""What the motion is: the stroboscopic map, and attractors, bifurcations, basins, chaos and fractals from it."""
