"""heyoka's Taylor integrator on starts in batches, one in each lane of a register: a peer that need not be installed.

All lanes advance together and each is in a mode of its own, so that there is one system for all modes, with switches
among its parameters. An event ends the step of its lane alone; a callback changes the switches, and the integration
goes on. The callback is compiled: in Python it took most of the time. What follows an event is what `peers` has with
the treatment "modes". See https://bluescarni.github.io/heyoka.py.
"""

from functools import lru_cache
from typing import Any

import numpy as np

from ..solver.jit import kernel
from ..solver.model import EXPONENT, PARAMETERS, TENSION, TENSION_ALLOW, VZ0, Z0
from . import heyoka_peer, peers
from .force_law import spring_and_damper

# Events, by the places of their functions.
GAP, SLIP, GRIP_BACKWARD, GRIP_FORWARD = range(4)
# Switches, behind the parameters: whether there is contact, the sign of the slip velocity, whether the part sticks.
CONTACT, SLIDES, STICKS = range(len(PARAMETERS), len(PARAMETERS) + 3)
# Their values by peers' modes: SIGN is none of heyoka's, then come FLIGHT, FORWARD, BACKWARD and STICK.
SWITCHES = np.array([[np.nan, np.nan, np.nan], [0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 0.0, 1.0]])

scales = kernel(peers.scales)


@kernel
def next_mode(parameters, t, state, event, in_contact):
    """The mode that follows an event, as `peers.next_mode` has it."""
    if event == GAP and in_contact:
        return peers.FLIGHT
    _, _, vx, ax = peers.plate_motion(parameters, t)
    slips = event == GAP and state[1] != vx
    if (event == SLIP or (event == GAP and not slips)) and peers.grip_of(t, state, parameters) >= 0.0:
        return peers.STICK
    return peers.FORWARD if (vx - state[1] if slips else ax) > 0.0 else peers.BACKWARD


@kernel
def change_mode(values, times, states, lane, event):
    """Change the switches in `values` after an event of a lane, and its state to be just beside the event's zero.

    Parameters
    ----------
    values : parameters and switches, shape (16, lanes)
    times : s, shape (lanes,)
    states : x, ẋ, z, ż (m, m/s), shape (4, lanes)
    """
    parameters, t, state = values[: len(PARAMETERS), lane].copy(), times[lane], states[:, lane].copy()
    mode = next_mode(parameters, t, state, event, values[CONTACT, lane] > 0.0)
    values[CONTACT:, lane] = SWITCHES[mode]
    z, _, vx, _ = peers.plate_motion(parameters, t)
    _, beside_vx, beside_z, _ = peers.BESIDE_OF_HEYOKA * scales(parameters)
    if event == GAP:
        states[2, lane] = z + (beside_z if mode == peers.FLIGHT else -beside_z)
    elif mode == peers.FORWARD:
        states[1, lane] = vx - beside_vx
    elif mode == peers.BACKWARD:
        states[1, lane] = vx + beside_vx


@lru_cache(maxsize=8)
def system(exponent: float, tolerance: float, lanes: int) -> Any:
    """The compiled integrator; its parameters and switches are set when it is used."""
    import heyoka as hy

    state = hy.make_vars("x", "vx", "z", "vz")
    x, vx, z, vz = state
    p, gap, rate, slip, pull = heyoka_peer.quantities(state)
    contact, slides, sticks = (hy.par[place] for place in (CONTACT, SLIDES, STICKS))
    # A power of a negative depth is no number, and no switch makes one of it.
    depth = hy.select(hy.gt(contact, 0.5), -gap, 1.0)
    push = contact * spring_and_damper(p["stiffness"], depth**exponent, p["damping"], rate) / p["mass"]
    rub = p["friction"] * push
    # Each falls through zero where its event is; where its mode is another, it is a constant.
    ends = (
        (1.0 - 2.0 * contact) * gap,
        slides * slip + (1.0 - slides**2),
        sticks * (rub - pull) + (1.0 - sticks),
        sticks * (rub + pull) + (1.0 - sticks),
    )

    def after(event):
        def goes_on(integrator, _, lane):
            change_mode(integrator.pars, integrator.time, integrator.state, lane, event)
            return True

        return goes_on

    return hy.taylor_adaptive_batch(
        [(x, vx), (vx, slides * rub + sticks * pull), (z, vz), (vz, push - p["gravity"])],
        np.zeros((4, lanes)),
        tol=tolerance,
        pars=np.zeros((len(PARAMETERS) + len(SWITCHES[0]), lanes)),
        # Beside its zero an event is not found again: none has to be kept from that for a while.
        t_events=[
            hy.t_event_batch(function, callback=after(event), direction=hy.event_direction.negative, cooldown=0.0)
            for event, function in enumerate(ends)
        ],
    )


def velocities_of_batch(integrator: Any, batch: np.ndarray, duration: float, limit: int, last: float) -> np.ndarray:
    """`mean_velocities` of as many starts as the integrator has lanes; all NaN where it fails in one of them."""
    import heyoka as hy

    integrator.set_time(0.0)
    integrator.pars[: len(PARAMETERS)] = batch.T
    for lane, row in enumerate(batch):
        z = peers.plate_motion(row, 0.0)[0] if np.isnan(row[Z0]) else row[Z0]
        state = np.array([0.0, 0.0, z, row[VZ0]])
        integrator.state[:, lane] = state
        integrator.pars[CONTACT:, lane] = SWITCHES[peers.next_mode(row, 0.0, state, None, peers.SIGN)]
    positions, steps = [], limit // integrator.order + 1
    for end in ((1.0 - last) * duration, duration):
        integrator.propagate_until(end, max_steps=steps)
        if any(outcome != hy.taylor_outcome.time_limit for outcome, *_ in integrator.propagate_res):
            return np.full(len(batch), np.nan)
        positions.append(integrator.state[0].copy())
    return (positions[1] - positions[0]) / (last * duration)


def mean_velocities(
    rows: np.ndarray, duration: float, tolerance: float, lanes: int, limit: int, last: float = 0.25
) -> np.ndarray:
    """Mean velocities (m/s) of starts over the last part of their runs, shape (n,); NaN where a batch is given up.

    Parameters
    ----------
    rows : float64, shape (n, 13), from `model.pack`, of one exponent
    duration : s
    tolerance : relative tolerance
    lanes : starts of a batch; the last batch is filled up with copies of the last start
    limit : evaluations of the right-hand side, of each start before the last part and in it
    last : share of the run over which the velocity is taken

    Raises
    ------
    ValueError
        for several exponents, or a contact other than with tension = allow
    """
    if np.any(rows[:, TENSION] != TENSION_ALLOW) or np.any(rows[:, EXPONENT] != rows[0, EXPONENT]):
        raise ValueError("heyoka follows the contact with tension = allow only, and batches of one exponent")
    integrator = system(float(rows[0, EXPONENT]), tolerance, lanes)
    filled = np.minimum(np.arange(-(-len(rows) // lanes) * lanes), len(rows) - 1)
    found = [
        velocities_of_batch(integrator, rows[places], duration, limit, last) for places in filled.reshape(-1, lanes)
    ]
    return np.concatenate(found)[: len(rows)]
