"""Code that the stages share: tables, axes of the config, states of motion of initial conditions, logs."""
