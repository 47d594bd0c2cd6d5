"""The page to play with: solver, drawing, and what puts them into one file."""
