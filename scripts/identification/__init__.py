"""Stage identification: which parameters the numbers of the paper imply."""
