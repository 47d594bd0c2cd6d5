"""Stage docs: pages from results."""
