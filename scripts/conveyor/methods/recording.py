"""What a lane of fixed steps leaves behind: samples, events, and its results at the end."""

import math

import numpy as np

from ..solver import model
from ..solver.jit import compiled_inline
from ..solver.record import IMPACT, SEPARATED
from ..solver.status import NOT_FINITE, OK
from . import scheme
from .scheme import shapes_at


@compiled_inline
def record_samples(parameters, first, memory, running, samples, number):
    """Write the sample with a `number` of the trajectories that are `running`, and let the peaks count from here on.

    first : row of the trajectory in the first lane
    """
    for lane in range(len(running)):
        if running[lane]:
            mass, row = parameters[first + lane, model.MASS], samples[first + lane, number]
            for column in range(4):
                row[column] = memory[column, lane]
            row[4] = mass * memory[scheme.PUSH, lane]
            row[5] = mass * memory[scheme.RUB, lane] + 0.0  # no negative zero
        memory[scheme.IMPACT_SPEED, lane] = memory[scheme.PEAK_FORCE, lane] = 0.0


@compiled_inline
def record_results(parameters, first, memory, running, results, step, evaluations, is_end):
    """Write the results of trajectories that end here: all of them, or those whose state is not finite.

    Returns the number of trajectories that are still `running`, shape (lanes,), which is changed.
    """
    still_running = 0
    for lane in range(len(running)):
        total = 0.0
        for column in range(4):
            total += memory[column, lane]
        finite = math.isfinite(total)
        if running[lane] and (is_end or not finite):
            running[lane] = False
            row = results[first + lane]
            for column in range(scheme.RESULTS):
                row[column] = memory[column, lane]
            row[scheme.CONTACT_TIME] *= step
            row[scheme.PEAK_FORCE] *= parameters[first + lane, model.MASS]
            row[scheme.FORCE_EVALUATIONS] = evaluations
            row[scheme.STATUS] = OK if finite else NOT_FINITE
        still_running += running[lane]
    return still_running


@compiled_inline
def record_events(kind, first, flat, memory, running, events, time):
    """Count the gaps that have opened or closed, and write the time (s) and kind of the first events."""
    for lane in range(len(running)):
        touching = memory[scheme.GAP, lane] <= 0.0
        if touching != memory[scheme.IN_CONTACT, lane]:
            n_events = int(memory[scheme.EVENTS, lane])
            if running[lane] and n_events < events.shape[1]:
                events[first + lane, n_events, 0] = time
                events[first + lane, n_events, 1] = IMPACT if touching else SEPARATED
            memory[scheme.EVENTS, lane] += 1.0
            memory[scheme.IMPACTS, lane] += touching
            if touching:
                phase = memory[scheme.OMEGA, lane] * time + memory[scheme.PSI0, lane]
                shapes = shapes_at(kind, flat, np.uint64(lane), phase)
                speed = memory[scheme.PLATE_VZ, lane] * shapes.vz - memory[scheme.VZ, lane]
                memory[scheme.IMPACT_SPEED, lane] = max(memory[scheme.IMPACT_SPEED, lane], speed)
            memory[scheme.IN_CONTACT, lane] = touching
