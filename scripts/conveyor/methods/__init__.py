"""What the solver is compared with: fixed steps, and the model for integrators of SciPy."""
