"""The stroboscopic map: the vertical motion over exactly one excitation cycle, and its linearisation.

A state is the pair (δ, v) at the phase ψ0: penetration δ = z_s - z_p (m, negative in flight) and its rate v (m/s). It
says everything, since contact is δ > 0 and the sign of the contact force follows from δ and v.

Perturbations are those of (δ, Y) with Y = v + (d_c/m) max(δ, 0), for which the equations of motion

    δ̇ = Y - (d_c/m) max(δ, 0),   Ẏ = g + a_z cos θ - (k_c/m) max(δ, 0)^p

are continuous across impact and separation, so that the linearised flow needs no jump there. Its determinant over a
cycle is exp(-(d_c/m) T_contact), with T_contact the time with a contact force. `clip` switches the damping off while
the force would pull; the force is continuous there, and v takes the place of Y.
"""

import math

import numpy as np

from . import contact, polynomial
from .contact import FIRST
from .flight import gap, next_impact
from .jit import kernel
from .model import TENSION_ALLOW, TENSION_CLIP, VZ0, Z0
from .polynomial import ORDER, SIZE
from .trajectory import MAX_PIECES, NOT_FINITE, OK, TOO_MANY_EVENTS, begin, in_contact, invert_time, press_on

# What a cycle is characterised by.
IMPACTS, CONTACT_TIME, LONGEST_FLIGHT, MAX_GAP, SLOWEST_IMPACT, AIRBORNE = range(6)
FEATURES = 6


@kernel
def initial_state(parameters, tolerance, state):
    """Fill `state`, shape (2,), with δ (m) and v (m/s) of the start in a packed parameter vector."""
    c = contact.constants(parameters, tolerance)
    q, rate = begin(c, parameters[Z0], parameters[VZ0], c.psi0)
    state[0] = -q
    state[1] = -rate


@kernel
def expand_tangent(c, series, tangent, free):
    """Taylor coefficients of a perturbation along a contact step: rows η, ζ of `tangent`, from their values at s = 0.

    With the derivative in s, η' = w (ζ - (d_c/m) η) and ζ' = -p (k_c/m) w^(2p-1) η. `free` leaves the force out.
    """
    w, square, stiff = series[FIRST + contact.W], series[FIRST + contact.SQUARE], series[contact.SCRATCH]
    eta, zeta = tangent[0], tangent[1]
    damping = 0.0 if free else c.damping
    stiffness = 0.0 if free else c.exponent * c.stiffness
    hertz = c.exponent == 1.5
    hooke = c.exponent == 1.0
    if not hertz and not hooke:
        power = 2.0 * c.exponent - 1.0
        general = w[0] > c.edge_w
        stiff[:] = 0.0
        if general:
            stiff[0] = w[0] ** power
            for n in range(1, ORDER):
                stiff[n] = contact.power_term(series, FIRST + contact.W, contact.SCRATCH, power, n)
    for n in range(ORDER):
        drift = 0.0
        pull = 0.0
        if hertz:
            for k in range(n + 1):
                drift += w[k] * (zeta[n - k] - damping * eta[n - k])
                pull += square[k] * eta[n - k]
        elif hooke:
            for k in range(n + 1):
                drift += w[k] * (zeta[n - k] - damping * eta[n - k])
                pull += w[k] * eta[n - k]
        else:
            for k in range(n + 1):
                drift += w[k] * (zeta[n - k] - damping * eta[n - k])
                pull += stiff[k] * eta[n - k]
        eta[n + 1] = drift / (n + 1)
        zeta[n + 1] = -stiffness * pull / (n + 1)


@kernel
def tangent_length(c, expansion):
    """Length in s at which the last two terms of a perturbation's expansion are below the tolerance.

    A perturbation rings at the frequency of the contact, also where the motion itself is slow or at rest.
    """
    scale = c.omega * abs(expansion[0, 0]) + abs(expansion[1, 0])
    length = 1e300
    for order in (ORDER - 1, ORDER):
        last = max(c.omega * abs(expansion[0, order]), abs(expansion[1, order]))
        if last > 0.0:
            length = min(length, (c.tolerance * scale / last) ** (1.0 / order))
    return length


@kernel
def cycle(c, series, state, tangent, features):
    """Advance `state` by one excitation cycle, exactly.

    Parameters
    ----------
    c, series : contact.Constants and a contact.workspace to work in
    state : float64, shape (2,), δ (m) and v (m/s) at the phase ψ0; replaced
    tangent : float64, shape (n, 2), n perturbations of (δ, Y); replaced; n = 0 where none are wanted
    features : float64, shape (6,), replaced but for AIRBORNE, the time (s) since the last separation, which goes on:
        number of impacts, time with contact force (s), longest flight that ended (s), largest gap (m),
        slowest impact (m/s; infinity without one)

    Returns
    -------
    status code of trajectory.STATUS
    """
    speed_z = c.a_z / c.omega
    height = speed_z / c.omega
    expansions = np.zeros((tangent.shape[0], 2, SIZE))
    features[IMPACTS] = features[CONTACT_TIME] = features[LONGEST_FLIGHT] = features[MAX_GAP] = 0.0
    features[SLOWEST_IMPACT] = math.inf
    t = 0.0
    theta = c.psi0
    sine, cosine = math.sin(theta), math.cos(theta)
    penetration, v = state[0], state[1]
    touching = in_contact(c, -penetration, -v, theta)
    w = math.sqrt(max(penetration, 0.0))
    pulled = touching and c.tension != TENSION_ALLOW and contact.force(c, w, v) < 0.0
    if pulled and c.tension == TENSION_CLIP:
        for i in range(tangent.shape[0]):
            tangent[i, 1] -= c.damping * tangent[i, 0]
    q, rate = -penetration, -v
    z, vz = q - height * cosine, rate + speed_z * sine
    for _ in range(MAX_PIECES):
        remaining = c.period - t
        if not touching:
            tau, speed, highest = next_impact(z, vz, q, rate, theta, c.gravity, c.a_z, c.omega, remaining)
            features[MAX_GAP] = max(features[MAX_GAP], highest)
            flown = min(tau, remaining)
            for i in range(tangent.shape[0]):
                tangent[i, 0] += tangent[i, 1] * flown
            features[AIRBORNE] += flown
            if not tau < math.inf:
                q, rate = gap(z, vz, remaining, theta, c.gravity, c.a_z, c.omega)
                state[0], state[1] = -max(q, 0.0), -rate
                return OK if math.isfinite(q) else NOT_FINITE
            features[IMPACTS] += 1.0
            features[LONGEST_FLIGHT] = max(features[LONGEST_FLIGHT], features[AIRBORNE])
            features[SLOWEST_IMPACT] = min(features[SLOWEST_IMPACT], speed)
            features[AIRBORNE] = 0.0
            touching = True
            pulled = False
            t += tau
            w, v = 0.0, speed
            theta = c.psi0 + c.omega * t
            sine, cosine = math.sin(theta), math.cos(theta)
            continue
        if w == 0.0 and v <= c.rest_speed:
            if c.gravity + c.a_z * cosine > 0.0:
                w, v, lapse = press_on(c, theta)
                t += lapse
            elif v <= 0.0:
                touching = False
                q, rate = 0.0, 0.0
                z, vz = -height * cosine, speed_z * sine
                continue
        length, w_end, v_end, lapse, event = contact.step(c, series, FIRST, w, v, sine, cosine, pulled)
        free = pulled and c.tension == TENSION_CLIP
        shorter = length
        for i in range(tangent.shape[0]):
            expansions[i, 0, 0], expansions[i, 1, 0] = tangent[i, 0], tangent[i, 1]
            expand_tangent(c, series, expansions[i], free)
            shorter = min(shorter, tangent_length(c, expansions[i]))
        cut = shorter < length
        if cut:
            length, event = shorter, contact.NOTHING
            lapse = polynomial.value(series, FIRST + contact.T, length)
        complete = not lapse < remaining
        if complete:
            length = invert_time(series, FIRST, length, remaining)
            lapse = remaining
        if complete or cut:
            w_end = polynomial.value(series, FIRST + contact.W, length)
            v_end = polynomial.value(series, FIRST + contact.V, length)
        for i in range(tangent.shape[0]):
            tangent[i, 0] = polynomial.value(expansions[i], 0, length)
            tangent[i, 1] = polynomial.value(expansions[i], 1, length)
        w, v = w_end, v_end
        if not free:
            features[CONTACT_TIME] += lapse
        if not (math.isfinite(w) and math.isfinite(v)):
            return NOT_FINITE
        if complete:
            if free:
                for i in range(tangent.shape[0]):
                    tangent[i, 1] += c.damping * tangent[i, 0]
            state[0], state[1] = w * w, v
            return OK
        t += lapse
        theta = c.psi0 + c.omega * t
        sine, cosine = math.sin(theta), math.cos(theta)
        if event == contact.SEPARATION and v >= -c.rest_speed and c.gravity + c.a_z * cosine > 0.0:
            v = 0.0
        elif event == contact.SEPARATION:
            touching = False
            q, rate = 0.0, -v
            z, vz = -height * cosine, speed_z * sine - v
        elif event == contact.FORCE_SIGN:
            pulled = not pulled
            if c.tension == TENSION_CLIP:
                sign = -1.0 if pulled else 1.0
                for i in range(tangent.shape[0]):
                    tangent[i, 1] += sign * c.damping * tangent[i, 0]
    return TOO_MANY_EVENTS


@kernel
def follow(parameters, tolerance, state, cycles, strobes, features):
    """Advance `state` by a number of cycles.

    strobes : float64, shape (cycles, 2), filled with δ and v after each cycle
    features : float64, shape (cycles, 6), filled with the features of each cycle
    Returns the status code; rows behind a failure are NaN.
    """
    c = contact.constants(parameters, tolerance)
    series = contact.workspace()
    no_tangent = np.empty((0, 2))
    found = np.zeros(FEATURES)
    strobes[:] = np.nan
    features[:] = np.nan
    for n in range(cycles):
        status = cycle(c, series, state, no_tangent, found)
        if status != OK:
            return status
        strobes[n, :] = state
        features[n, :] = found
    return OK


@kernel
def monodromy(parameters, tolerance, state, matrices, features):
    """Advance `state` by n cycles and fill `matrices`, shape (n, 2, 2), with ∂(δ, Y)_end/∂(δ, Y)_start of each cycle.

    The monodromy matrix is their product; its determinant is the product of theirs without loss of digits.
    features : float64, shape (n, 6), filled with the features of each cycle. Returns the status code.
    """
    c = contact.constants(parameters, tolerance)
    series = contact.workspace()
    found = np.zeros(FEATURES)
    for n in range(matrices.shape[0]):
        tangent = np.eye(2)
        status = cycle(c, series, state, tangent, found)
        features[n, :] = found
        matrices[n, :, :] = tangent.T
        if status != OK:
            return status
    return OK
