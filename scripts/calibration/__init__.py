"""Calibration: parameters of the contact from measured velocities."""
