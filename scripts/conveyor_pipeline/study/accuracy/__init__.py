"""Stage accuracy: accuracy, speed and robustness of the solver and of the estimators."""
