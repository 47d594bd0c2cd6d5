"""Stage accuracy: how accurate, how fast, how robust the solver and the estimates are."""
