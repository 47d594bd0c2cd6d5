"""Calibration: parameters of the contact from measured velocities, or from the numbers of the paper."""
