"""What the solver is compared with: fixed steps, integrators of others."""
