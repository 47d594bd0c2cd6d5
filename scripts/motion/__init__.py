"""Stage motion: signals, their spectra, first impacts, critical initial heights."""
