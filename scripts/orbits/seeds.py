"""Stable orbits to begin with: those of the config, or those that starts all over the range of amplitudes end in."""

from collections.abc import Iterator

import numpy as np

from conveyor.analysis import stroboscopic_map
from conveyor.analysis.attractors import sampling
from conveyor.analysis.bifurcations import periodic_orbits
from conveyor.analysis.bifurcations.periodic_orbits import Orbit
from conveyor.solver.model import ACCELERATION
from pipeline import grid

# Where nothing is said of seeds: amplitudes between the limits, and starts at each.
AMPLITUDES, STARTS = 15, 8
DIGITS = 4  # of the longest flight, by which orbits of one period and amplitude are told apart


def follow_seeds(parameters: np.ndarray, settings: dict) -> list[Orbit]:
    """The stable orbits that the starts of the settings end in.

    Raises
    ------
    ValueError
        names the start that does not end in one
    """
    found = []
    for start in settings["seeds"]:
        row = grid.product({name: [value] for name, value in start.items()}, settings["model"])[1]
        state = stroboscopic_map.initial_states(row, periodic_orbits.TOLERANCE)[0]
        orbit, _ = periodic_orbits.settled_orbit(
            row[0], start["acceleration"], state, range(1, settings["max_period"] + 1), settings["cycles"]
        )
        if orbit is None:
            raise ValueError(
                f"orbits.seeds: {start} ends in no stable orbit of up to {settings['max_period']} cycles; "
                "choose another amplitude or more cycles"
            )
        found.append(orbit)
    return found


def search_seeds(parameters: np.ndarray, settings: dict) -> Iterator[Orbit]:
    """The stable orbits that starts at amplitudes between the limits end in, each once at each amplitude."""
    for acceleration in np.linspace(*settings["limits"], AMPLITUDES + 2)[1:-1]:
        row = parameters.copy()
        row[ACCELERATION] = acceleration
        at_rest = stroboscopic_map.initial_states(row[None], periodic_orbits.TOLERANCE)
        seen = set()
        for state in np.vstack([at_rest, sampling.initial_conditions(row)[:STARTS]]):
            orbit, _ = periodic_orbits.settled_orbit(
                parameters, acceleration, state, range(1, settings["max_period"] + 1), settings["cycles"]
            )
            if orbit is not None and (key := (orbit.period, round(orbit.longest_flight, DIGITS))) not in seen:
                seen.add(key)
                yield orbit


def seeds(parameters: np.ndarray, settings: dict) -> list[Orbit]:
    """The stable orbits with which branches begin.

    Raises
    ------
    ValueError
        if there are none, or a given start does not end in one
    """
    if "seeds" in settings:
        return follow_seeds(parameters, settings)
    found = list(search_seeds(parameters, settings))
    if not found:
        raise ValueError(
            f"orbits.seeds: no start between {settings['limits']} m/s² ends in a stable orbit of up to "
            f"{settings['max_period']} cycles; choose other limits, or give seeds"
        )
    return found
