"""Stage motion: signals, spectra, first impacts and critical initial heights."""
