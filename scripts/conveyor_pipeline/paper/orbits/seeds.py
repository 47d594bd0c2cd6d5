"""Stable orbits as seeds of branches: from initial conditions of the config, or from a search over all amplitudes."""

from collections.abc import Iterator

import numpy as np

from conveyor import Orbit, initial_states, periodic_orbit, replace_parameters
from conveyor.analysis.attractors.sampling import sampled_initial_conditions
from conveyor.analysis.bifurcations.periodic_orbits import ORBIT_TOLERANCE
from conveyor_pipeline.common import grid
from conveyor_pipeline.common.rule_log import JobError

# Size of the search: amplitudes between the limits, and initial conditions at each.
AMPLITUDES, INITIAL_CONDITIONS = 15, 8
CYCLES = 800  # excitation cycles, after which a trajectory is close to its orbit
DIGITS = 4  # of the longest flight, by which orbits with the same period and amplitude are distinguished


def follow_seeds(settings: dict) -> list[Orbit]:
    """The stable orbits that the seeds of the config lead to.

    Raises
    ------
    JobError
        names the seed that does not lead to a stable orbit
    """
    orbits = []
    for seed in settings["seeds"]:
        (row,) = grid.product({name: [value] for name, value in seed.items()}, settings["model"])[1]
        orbit = periodic_orbit(row, period=range(1, settings["max_period"] + 1), transient=CYCLES)
        if orbit is None:
            raise JobError(
                f"orbits.seeds: {seed} leads to no stable orbit of up to {settings['max_period']} cycles; "
                "choose another amplitude or more cycles, or give orbits.seeds: [] to search all amplitudes"
            )
        orbits.append(orbit)
    return orbits


def search_seeds(parameters: np.ndarray, settings: dict) -> Iterator[Orbit]:
    """The different stable orbits that some initial conditions lead to, at amplitudes between the limits."""
    for acceleration in np.linspace(*settings["limits"], AMPLITUDES + 2)[1:-1]:
        row = replace_parameters(parameters, acceleration=acceleration)
        at_rest = initial_states(row[None], tolerance=ORBIT_TOLERANCE)
        seen = set()
        for state in np.vstack([at_rest, sampled_initial_conditions(row)[:INITIAL_CONDITIONS]]):
            orbit = periodic_orbit(row, state, period=range(1, settings["max_period"] + 1), transient=CYCLES)
            if orbit is not None and (key := (orbit.period, round(orbit.longest_flight, DIGITS))) not in seen:
                seen.add(key)
                yield orbit


def seeds(parameters: np.ndarray, settings: dict) -> list[Orbit]:
    """The stable orbits from which branches are continued; the search may find none.

    Raises
    ------
    JobError
        if a seed of the config does not lead to one
    """
    return follow_seeds(settings) if settings["seeds"] else list(search_seeds(parameters, settings))
