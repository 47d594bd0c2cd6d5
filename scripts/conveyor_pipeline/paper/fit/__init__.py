"""Stage fit: Eq. 13 fitted to critical initial heights."""
