"""Parts as planar rigid blocks, which touch the plate with their corners."""
