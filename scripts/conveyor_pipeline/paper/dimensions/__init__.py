"""Stage dimensions: fractal dimensions of phase portraits."""
