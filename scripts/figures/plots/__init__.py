"""One module for each figure; config/defaults/figures.yaml names the arguments of its function `plot`."""
