"""Findings of the floor machine: what claims.yaml names as `finding`."""
