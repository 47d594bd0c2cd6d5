"""Stage claims: the paper's statements, measured on the tables, with verdicts."""
