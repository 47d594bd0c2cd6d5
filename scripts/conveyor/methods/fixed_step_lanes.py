"""Fixed steps of several trajectories side by side, in plain loops that LLVM turns into vector code.

A single trajectory is the same code with one lane. With one lane, sweeps over amplitudes or ψ0 would take four to five
and a half times as long. A result depends neither on its lane nor on its neighbours.
"""

import functools
import math

import numpy as np

from ..parameters import PARAMETERS
from ..solver import model, plate
from ..solver.contact_lanes import LANES
from ..solver.contact_law import coefficients_per_mass
from ..solver.jit import compiled_entry, compiled_inline
from . import scheme
from .force_law import least_push, least_rub
from .recording import record_events, record_results, record_samples
from .scheme import Kind, count_step, find_forces, shapes_at, take_step, turn_plate, written_shapes
from .sine import sine_and_cosine

FIRST_WAVE = len(PARAMETERS)  # place of the first harmonic in packed parameters
CHECK = 256  # steps between checks that the state is finite, and that nothing has stopped the run


@compiled_inline
def turn_plates(kind, memory, i, step, shapes):
    """Write the Shapes at the ends of CHECK steps of explicit Euler from number i on, for alike plates.

    In this loop, LLVM computes the sines of several steps at once. Otherwise sweeps over amplitudes would take 1.6
    times as long, and a single trajectory 1.4 times; with semi-implicit Euler, single trajectories would be slower.
    """
    for n in range(CHECK):
        at = np.uint64(n)
        end, _, _ = turn_plate(kind, memory, np.uint64(0), i + n, step)
        for k in range(4):
            shapes[at + np.uint64(k * CHECK)] = end[k]


@compiled_inline
def take_steps(kind, lanes, memory, i, stop, step, plates):
    """Take steps from number i on, to `stop` or until a gap opens or closes. Returns the number of the next step.

    plates : from `turn_plates`, for the CHECK steps that hold these ones
    """
    changed = False
    while not changed and i != stop:
        if kind.alike and kind.method == scheme.EULER:
            end = written_shapes(plates, np.uint64(i % CHECK), np.uint64(CHECK))
            shapes = end, end, end
        elif kind.alike:
            shapes = turn_plate(kind, memory, np.uint64(0), i, step)
        for k in range(lanes):
            lane = np.uint64(k)
            if not kind.alike:
                shapes = turn_plate(kind, memory, lane, i, step)
            count_step(memory, lane)
            take_step(kind, memory, lane, shapes, step)
            changed |= find_forces(kind, memory, lane, shapes[0])
        i += 1
    return i


@compiled_inline
def prepare(kind, parameters, flat, memory, lane):
    """Set a lane of the memory, zero before, to the initial condition of a packed parameter vector."""
    sine_angle, cosine_angle = sine_and_cosine(parameters[model.ANGLE])
    sine_track, cosine_track = sine_and_cosine(parameters[model.INCLINATION])
    ahead, straight = sine_and_cosine(parameters[model.PHASE_SHIFT])
    omega = 2.0 * math.pi * parameters[model.FREQUENCY]
    a_z, a_x = parameters[model.ACCELERATION] * sine_angle, parameters[model.ACCELERATION] * cosine_angle
    memory[scheme.OMEGA, lane], memory[scheme.PSI0, lane] = omega, parameters[model.PSI0]
    amplitudes = plate.amplitudes(a_x, a_z, omega)
    memory[scheme.PLATE_Z, lane], memory[scheme.PLATE_VZ, lane] = amplitudes.z, amplitudes.vz
    memory[scheme.PLATE_VX, lane], memory[scheme.PLATE_AX, lane] = amplitudes.vx, amplitudes.ax
    memory[scheme.STIFFNESS, lane], memory[scheme.DAMPING, lane] = coefficients_per_mass(parameters)
    memory[scheme.EXPONENT, lane] = parameters[model.EXPONENT]
    memory[scheme.FRICTION, lane] = parameters[model.FRICTION]
    memory[scheme.STATIC_FRICTION, lane] = parameters[model.STATIC_FRICTION]
    memory[scheme.GRAVITY, lane] = parameters[model.GRAVITY] * cosine_track
    memory[scheme.DOWNHILL, lane] = parameters[model.GRAVITY] * sine_track
    memory[scheme.SIN_SHIFT, lane], memory[scheme.COS_SHIFT, lane] = ahead, straight
    memory[scheme.LEAST_PUSH, lane] = least_push(parameters[model.TENSION])
    memory[scheme.LEAST_RUB, lane] = least_rub(parameters[model.TENSION])
    for k in range(len(parameters) - FIRST_WAVE):
        memory[scheme.WAVES + k, lane] = parameters[FIRST_WAVE + k]
    shapes = shapes_at(kind, flat, np.uint64(lane), parameters[model.PSI0])
    memory[scheme.LAST_SLIP, lane] = memory[scheme.PLATE_VX, lane] * shapes.vx
    surface = memory[scheme.PLATE_Z, lane] * shapes.z
    memory[scheme.Z, lane] = surface if math.isnan(parameters[model.Z0]) else parameters[model.Z0]
    memory[scheme.VZ, lane] = parameters[model.VZ0]
    memory[scheme.MAX_GAP, lane] = memory[scheme.Z, lane] - surface
    memory[scheme.IN_CONTACT, lane] = memory[scheme.MAX_GAP, lane] <= 0.0
    find_forces(kind, flat, np.uint64(lane), shapes)


@functools.cache
def compiled_for(kind):
    """The compiled part of `follow` for a Kind."""
    method = kind.method

    @compiled_entry
    def integrate(parameters, step, n_steps, sample_indices, samples, events, results, stopped, work):
        flat, memory = work
        lanes = 1 if kind.single else LANES
        running = np.empty(lanes, np.bool_)
        plates = np.empty(4 * CHECK)
        for first in range(0, len(parameters), lanes):
            # A lane without a trajectory hangs in the air, without gravity.
            for k in range(len(flat)):
                flat[k] = 0.0
            for lane in range(lanes):
                memory[scheme.Z, lane] = memory[scheme.GAP, lane] = 1.0
                running[lane] = first + lane < len(parameters)
                if running[lane]:
                    prepare(kind, parameters[first + lane], flat, memory, lane)
            i = n_sampled = 0
            while True:
                while n_sampled < len(sample_indices) and sample_indices[n_sampled] <= i:
                    record_samples(parameters, first, memory, running, samples, n_sampled)
                    n_sampled += 1
                if i % CHECK == 0 or i == n_steps:
                    evaluations = i * scheme.EVALUATIONS[method]
                    is_end = i == n_steps or stopped[0]
                    if record_results(parameters, first, memory, running, results, step, evaluations, is_end) == 0:
                        break
                    if kind.alike and method == scheme.EULER:
                        turn_plates(kind, flat, i, step, plates)
                record_events(kind, first, flat, memory, running, events, i * step)
                stop = min(n_steps, i - i % CHECK + CHECK)
                if n_sampled < len(sample_indices):
                    stop = min(stop, sample_indices[n_sampled])
                i = take_steps(kind, lanes, flat, i, stop, step, plates)

    return integrate


def kind_of(method: int, parameters: np.ndarray) -> Kind:
    """The Kind of steps with the code of a method that trajectories need, for packed `parameters`, shape (n, 16)."""
    waves = parameters[:, FIRST_WAVE:]
    orders = waves[0, plate.K :: plate.NUMBERS].astype(np.int64)
    if (waves[:, plate.K :: plate.NUMBERS] != orders).any():
        raise ValueError("harmonics of conveyors that are followed together must have the same orders")
    rows = np.zeros(orders.max(initial=1) + 1, np.int64)
    rows[orders] = scheme.WAVES + plate.NUMBERS * np.arange(len(orders))
    plates = np.hstack([parameters[:, [model.FREQUENCY, model.PSI0, model.PHASE_SHIFT]], waves])
    return Kind(
        method,
        single=len(parameters) == 1,
        alike=bool((plates == plates[:1]).all()),
        sticks=bool((parameters[:, model.STATIC_FRICTION] > parameters[:, model.FRICTION]).any()),
        has_powers=bool((~np.isin(parameters[:, model.EXPONENT], (1.0, 1.5))).any()),
        waves=tuple(rows.tolist()) if len(orders) else None,
    )
