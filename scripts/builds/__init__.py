"""Stage builds: what a build holds, and where it comes from."""
