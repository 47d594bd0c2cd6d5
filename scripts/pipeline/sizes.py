"""Numbers of rows that computing a table and estimating its cost share. This module imports nothing."""

# Rows of a row group: fixed, so that a table's bytes do not depend on how it was computed.
ROW_GROUP = 1 << 20
# Rows per block of a sweep; one block takes a few hundred MB.
BLOCK = 1 << 18
