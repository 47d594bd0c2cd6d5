"""Stage docs: pages that are made from results."""
