"""Stage orbits: periodic orbits, attractors, their Lyapunov exponents, and certificates."""
