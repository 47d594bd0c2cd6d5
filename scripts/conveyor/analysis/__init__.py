"""What the motion is: stroboscopic map, states, orbits, exponents, dimensions, spectra, fits."""
