"""Measures of chaos: Lyapunov exponents and the 0-1 test."""
