"""Stage orbits: periodic orbits, attractors, their exponents, and what is proved of them."""
