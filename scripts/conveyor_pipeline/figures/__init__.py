"""Stage figures: plots and captions."""
