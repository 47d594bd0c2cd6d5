"""Measures of chaos: Lyapunov exponents and random walks."""
