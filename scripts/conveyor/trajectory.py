"""The event loop: flight, impact, contact, separation; slip and stick beside it.

Time is kept as whole excitation cycles plus a time within the cycle, so that the phase of a run of any length has the
same precision.
"""

import math

import numpy as np

from . import contact, friction, memory, polynomial
from .flight import next_impact
from .jit import kernel
from .model import TENSION_ALLOW, TENSION_CLIP, VZ0, Z0

# Phase at which a cycle is taken to begin, rad.
BEGIN_OF_CYCLE = -math.pi

# What ends a contact step besides contact.NOTHING, SEPARATION and FORCE_SIGN.
END_OF_CYCLE = 3

# Status of a run.
OK, TOO_MANY_EVENTS, NOT_FINITE = range(3)
STATUS = ("ok", "too many events", "not finite")

# Kinds of events.
IMPACT, SEPARATED, SLIP_REVERSAL, STICK, SLIP, TENSION_BEGINS, TENSION_ENDS = range(7)
EVENTS = ("impact", "separation", "slip reversal", "stick", "slip", "tension begins", "tension ends")

# Steps and flights within one excitation cycle after which a run is given up.
MAX_PIECES = 200_000

# Columns of a sample.
X, VX, Z, VZ, CONTACT_FORCE, FRICTION_FORCE = range(6)
SAMPLES = ("x", "vx", "z", "vz", "contact_force", "friction_force")


@kernel
def begin(c, z0, vz0, theta):
    """Gap (m) and its rate (m/s) at the start; exactly 0 for a start on the conveyor (z0 is NaN, Eq. 15)."""
    q = 0.0 if math.isnan(z0) else z0 + c.a_z / (c.omega * c.omega) * math.cos(theta)
    return q, vz0 - c.a_z / c.omega * math.sin(theta)


@kernel
def in_contact(c, q, rate, theta):
    """Whether a part with this gap and rate of the gap is in contact, or comes into it at once."""
    if q != 0.0:
        return q < 0.0
    if rate != 0.0:
        return rate < 0.0
    return c.gravity + c.a_z * math.cos(theta) > 0.0


@kernel
def press_on(c, theta):
    """√penetration, speed of approach and elapsed time just after a part at relative rest begins to sink in.

    At w = v = 0 the equations in s stand still. The motion leaves that point as δ = a τ²/2 with a = g + a_z cos θ.
    """
    acceleration = c.gravity + c.a_z * math.cos(theta)
    w = 1e-9 * c.scale_w
    v = math.sqrt(2.0 * acceleration) * w
    return w, v, v / acceleration


@kernel
def invert_time(series, at, length, tau):
    """The s in [0, length] of a contact step at which the time since its start is `tau` (s)."""
    low, high = 0.0, length
    total = polynomial.value(series, at + contact.T, length)
    if tau >= total:  # also a step that is too short to take time
        return length
    s = length * max(tau / total, 0.0)
    for _ in range(100):
        error = polynomial.value(series, at + contact.T, s) - tau
        w = polynomial.value(series, at + contact.W, s)
        if error > 0.0:
            high = s
        else:
            low = s
        newton = s - error / w if w > 0.0 else low
        s_next = newton if low < newton < high else 0.5 * (low + high)
        if abs(s_next - s) <= 4e-16 * length:
            return s_next
        s = s_next
    return s


@kernel
def integrate(parameters, tolerance, feeding, times, samples, event_times, event_kinds):
    """Follow one part until the last of `times` and sample it there.

    Parameters
    ----------
    parameters : float64, shape (13,), see model.PARAMETERS
    tolerance : relative error per step of the contact
    feeding : whether the horizontal motion is wanted; without it its columns are NaN
    times : float64, shape (n,), s, ascending, ≥ 0; the run ends at the last one
    samples : float64, shape (n, 6), filled with the columns SAMPLES (m, m/s, N)
    event_times, event_kinds : float64 (s) and int8, shape (m,), filled with the first m events

    Returns
    -------
    status, events, impacts, contact_time (s), max_gap (m), work : the status code, numbers of events and of impacts,
        time with contact force, largest gap, number of Taylor steps
    """
    c = contact.constants(parameters, tolerance)
    series, steps = memory.unused()
    speed_x = c.a_x / c.omega
    speed_z = c.a_z / c.omega
    height = speed_z / c.omega
    end = times[-1]
    room = event_times.size

    # Cycles begin at the plate's top, where a part that leaves the plate at all is in the air.
    offset = ((c.psi0 - BEGIN_OF_CYCLE) % (2.0 * math.pi)) / c.omega
    cycle = 0
    base = -offset
    t = offset
    theta = c.psi0
    sine, cosine = math.sin(theta), math.cos(theta)
    q, rate = begin(c, parameters[Z0], parameters[VZ0], theta)
    touching = in_contact(c, q, rate, theta)
    z = q - height * cosine
    vz = parameters[VZ0]
    w = v = 0.0
    x = vx = 0.0
    sigma = 0.0
    pulled = False
    next_sample = 0
    events = impacts = work = pieces = place = 0
    contact_time = 0.0
    max_gap = max(q, 0.0)
    status = OK

    if touching:
        w, v = math.sqrt(-q), -rate
        pulled = c.tension != TENSION_ALLOW and contact.force(c, w, v) < 0.0
        slip = speed_x * sine
        sigma = math.copysign(1.0, slip)
        if slip == 0.0:
            sigma = friction.direction_at_rest(c, c.a_x * cosine, contact.force(c, w, v), c.friction)

    while next_sample < times.size:
        pieces += 1
        if pieces > MAX_PIECES:
            status = TOO_MANY_EVENTS
            break
        if not touching:
            tau, speed, highest = next_impact(z, vz, q, rate, theta, c.gravity, c.a_z, c.omega, end - base - t)
            max_gap = max(max_gap, highest)
            while next_sample < times.size and base + t + tau >= times[next_sample]:
                ahead = times[next_sample] - base - t
                samples[next_sample, X] = x + vx * ahead
                samples[next_sample, VX] = vx
                samples[next_sample, Z] = z + (vz - 0.5 * c.gravity * ahead) * ahead
                samples[next_sample, VZ] = vz - c.gravity * ahead
                samples[next_sample, CONTACT_FORCE] = 0.0
                samples[next_sample, FRICTION_FORCE] = 0.0
                next_sample += 1
            if next_sample == times.size:
                break
            if not tau < math.inf:
                status = NOT_FINITE
                break
            x += vx * tau
            t += tau
            touching = True
            impacts += 1
            if events < room:
                event_times[events] = base + t
                event_kinds[events] = IMPACT
            events += 1
            w, v = 0.0, speed
            pulled = False
            theta = BEGIN_OF_CYCLE + c.omega * t
            sine, cosine = math.sin(theta), math.cos(theta)
            if feeding:
                slip = speed_x * sine - vx
                sigma = math.copysign(1.0, slip)
                if slip == 0.0:
                    sigma = friction.direction_at_rest(c, c.a_x * cosine, c.damping * v, c.friction)
        else:
            if w == 0.0 and v <= c.rest_speed:
                # Grazing: the part touches with no speed and is either pressed on or left behind by the plate.
                if c.gravity + c.a_z * cosine > 0.0:
                    w, v, lapse = press_on(c, theta)
                    t += lapse
                elif v <= 0.0:
                    touching = False
                    q, rate = 0.0, 0.0
                    z, vz = -height * cosine, speed_z * sine
                    if events < room:
                        event_times[events] = base + t
                        event_kinds[events] = SEPARATED
                    events += 1
                    continue
            at = memory.first_row(series, steps, place)
            if memory.repeats(c, steps, place, t, w, v, pulled):
                length, w_end, v_end, lapse, event, sine_end, cosine_end = memory.recall(steps, place)
            else:
                length, w_end, v_end, lapse, event = contact.step(c, series, at, w, v, sine, cosine, pulled)
                if t + lapse > c.period:
                    # Every cycle begins with a step of its own, so that its steps are comparable with the last one's.
                    lapse = c.period - t
                    length = invert_time(series, at, length, lapse)
                    w_end = polynomial.value(series, at + contact.W, length)
                    v_end = polynomial.value(series, at + contact.V, length)
                    event = END_OF_CYCLE
                if event == END_OF_CYCLE:
                    sine_end, cosine_end = math.sin(BEGIN_OF_CYCLE), math.cos(BEGIN_OF_CYCLE)
                else:
                    sine_end = polynomial.value(series, at + contact.SINE, length)
                    cosine_end = polynomial.value(series, at + contact.COSINE, length)
                memory.keep(steps, place, t, w, v, pulled, length, w_end, v_end, lapse, event, sine_end, cosine_end)
                work += 1
            place = min(place + 1, memory.PLACES - 1)
            pressing = not (pulled and c.tension == TENSION_CLIP)
            if pressing:
                # A repeated step has the lapse of the one it repeats; what counts is where the cycle ends.
                contact_time += min(c.period - t if event == END_OF_CYCLE else lapse, end - base - t)

            # The segments of constant slip direction within this step.
            mu = 0.0 if pulled else c.friction
            here = 0.0
            w_here, v_here, t_here, sine_here, cosine_here = w, v, 0.0, sine, cosine
            slip = speed_x * sine - vx
            fastest = max(-v, -v_end, 0.0)
            released = False
            while True:
                there = length
                changed = False
                if feeding and not released:
                    change = math.inf
                    if sigma == 0.0:
                        change, released = friction.stick_end(c, series, at, here, length, cosine_here, cosine_end)
                    else:
                        ahead = lapse - t_here
                        plate = sigma * speed_x * (sine_end - sine_here)
                        gain = speed_z * (sine_end - sine_here) - v_end + v_here + c.gravity * ahead
                        if not friction.keeps_slipping(
                            c, sigma * slip, plate, gain, ahead, cosine_here, cosine_end, fastest, mu
                        ):
                            change = friction.slip_end(c, series, at, here, length, slip, sigma, mu)
                    if change < length:
                        there = change
                        changed = True
                if changed:
                    w_there = polynomial.value(series, at + contact.W, there)
                    v_there = polynomial.value(series, at + contact.V, there)
                    t_there = polynomial.value(series, at + contact.T, there)
                    phase = theta + c.omega * t_there
                    sine_there, cosine_there = math.sin(phase), math.cos(phase)
                else:
                    w_there, v_there, t_there, sine_there, cosine_there = w_end, v_end, lapse, sine_end, cosine_end
                z_here = -height * cosine_here - w_here * w_here
                vz_here = speed_z * sine_here - v_here
                while next_sample < times.size and base + t + t_there >= times[next_sample]:
                    tau = times[next_sample] - base - t
                    s = invert_time(series, at, length, tau)
                    phase = theta + c.omega * tau
                    w_s, v_s = polynomial.value(series, at + contact.W, s), polynomial.value(series, at + contact.V, s)
                    samples[next_sample, Z] = -height * math.cos(phase) - w_s * w_s
                    samples[next_sample, VZ] = speed_z * math.sin(phase) - v_s
                    force = contact.force(c, w_s, v_s) if pressing else 0.0
                    samples[next_sample, CONTACT_FORCE] = c.mass * force
                    tau -= t_here
                    if sigma == 0.0:
                        samples[next_sample, X] = x - speed_x / c.omega * (math.cos(phase) - cosine_here)
                        samples[next_sample, VX] = speed_x * math.sin(phase)
                        samples[next_sample, FRICTION_FORCE] = c.mass * c.a_x * math.cos(phase)
                    else:
                        gain = samples[next_sample, VZ] - vz_here + c.gravity * tau
                        path = samples[next_sample, Z] - z_here - vz_here * tau + 0.5 * c.gravity * tau * tau
                        samples[next_sample, X] = x + vx * tau + sigma * mu * path
                        samples[next_sample, VX] = vx + sigma * mu * gain
                        samples[next_sample, FRICTION_FORCE] = c.mass * sigma * mu * force
                    next_sample += 1
                if next_sample == times.size:
                    break
                if feeding:
                    tau = t_there - t_here
                    if sigma == 0.0:
                        x -= speed_x / c.omega * (cosine_there - cosine_here)
                        vx = speed_x * sine_there
                    else:
                        z_there = -height * cosine_there - w_there * w_there
                        vz_there = speed_z * sine_there - v_there
                        x += vx * tau + sigma * mu * (z_there - z_here - vz_here * tau + 0.5 * c.gravity * tau * tau)
                        vx += sigma * mu * (vz_there - vz_here + c.gravity * tau)
                if not changed:
                    break
                pieces += 1
                if pieces > MAX_PIECES:
                    break
                vx = speed_x * sine_there
                force = contact.force(c, w_there, v_there)
                before = sigma
                if sigma == 0.0:
                    sigma = math.copysign(1.0, cosine_there)
                else:
                    sigma = friction.direction_at_rest(c, c.a_x * cosine_there, force, mu)
                if events < room:
                    event_times[events] = base + t + t_there
                    event_kinds[events] = SLIP if before == 0.0 else (STICK if sigma == 0.0 else SLIP_REVERSAL)
                events += 1
                here = there
                slip = 0.0
                w_here, v_here, t_here, sine_here, cosine_here = w_there, v_there, t_there, sine_there, cosine_there

            if next_sample == times.size:
                break
            t = c.period if event == END_OF_CYCLE else t + lapse
            theta, sine, cosine = BEGIN_OF_CYCLE + c.omega * t, sine_end, cosine_end
            w, v = w_end, v_end
            if not (math.isfinite(w) and math.isfinite(v) and math.isfinite(t)):
                status = NOT_FINITE
                break
            if event == contact.SEPARATION and v >= -c.rest_speed and c.gravity + c.a_z * cosine > 0.0:
                v = 0.0
            elif event == contact.SEPARATION:
                touching = False
                q, rate = 0.0, -v
                z, vz = -height * cosine, speed_z * sine - v
                if events < room:
                    event_times[events] = base + t
                    event_kinds[events] = SEPARATED
                events += 1
            elif event == contact.FORCE_SIGN:
                pulled = not pulled
                if events < room:
                    event_times[events] = base + t
                    event_kinds[events] = TENSION_BEGINS if pulled else TENSION_ENDS
                events += 1
        while t >= c.period:
            t -= c.period
            cycle += 1
            base = cycle * c.period - offset
            pieces = place = 0
            theta = BEGIN_OF_CYCLE + c.omega * t
    if not feeding:
        samples[:, X] = np.nan
        samples[:, VX] = np.nan
        samples[:, FRICTION_FORCE] = np.nan
    for n in range(next_sample, times.size):
        samples[n, :] = np.nan
    return status, events, impacts, contact_time, max_gap, work
