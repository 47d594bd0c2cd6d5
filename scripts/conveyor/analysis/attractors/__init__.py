"""Finding attractors, and the label of the attractor that an initial condition leads to."""
