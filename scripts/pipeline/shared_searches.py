"""When the initial conditions of one conveyor share a search for its attractors. This module imports nothing."""

# From this number of initial conditions, it costs less to find the conveyor's chaotic sets first, and then the
# neighbourhoods of its orbits.
CHAOS_SHARED = 8
ORBITS_SHARED = 200
# Below this total of excitation cycles over all initial conditions, this search takes longer than it saves.
CYCLES_SHARED = 32_000
