"""Stage identification: the parameters that the numbers of the paper imply."""
