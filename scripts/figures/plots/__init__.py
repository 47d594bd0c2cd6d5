"""One module for each figure, with a function `draw`."""
