"""Measures of chaos: Lyapunov exponents."""
