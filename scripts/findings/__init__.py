"""What the tables say about each checkable statement of the paper: one function per statement."""
