"""Numbers used to compute a table and to estimate its cost. This module imports nothing."""

# Rows of a row group: fixed, so that a table's bytes do not depend on how it was computed.
ROW_GROUP = 1 << 20
# Rows per block of a sweep; one block takes a few hundred MB.
BLOCK = 1 << 18

# From this number of initial conditions, it costs less to find the conveyor's chaotic sets first, and then the
# neighbourhoods of its orbits.
CHAOS_SHARED = 8
ORBITS_SHARED = 200
# Below this total of excitation cycles over all initial conditions, this search takes longer than it saves.
CYCLES_SHARED = 32_000

# Points of a map. All searches for a smaller table may together take as many cycles as those for a map.
WHOLE_MAP = 160_000
