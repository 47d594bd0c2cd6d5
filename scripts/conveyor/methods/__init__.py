"""What the solver is compared with: fixed steps, SciPy."""
