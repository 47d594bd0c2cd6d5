"""One module for each figure; config/figures.yaml names the arguments of its function `plot`."""
