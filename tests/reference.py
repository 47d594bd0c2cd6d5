"""A slow, independent solution of the model by SciPy's DOP853, with which tests compare the fast solvers."""

import math

import numpy as np
from scipy.integrate import solve_ivp

from conveyor import Conveyor, Start


def accelerations(conveyor: Conveyor, t: float) -> tuple[float, float]:
    """The plate's accelerations normal to the track and along it (m/s²), from the definition of the harmonics."""
    theta = 2.0 * math.pi * conveyor.frequency * t + conveyor.psi0
    normal = math.cos(theta) + sum(h.normal * math.cos(h.order * theta + h.normal_phase) for h in conveyor.harmonics)
    along = math.cos(theta + conveyor.phase_shift)
    along += sum(h.along * math.cos(h.order * theta + h.along_phase) for h in conveyor.harmonics)
    amplitude = conveyor.acceleration
    return amplitude * math.sin(conveyor.angle) * normal, amplitude * math.cos(conveyor.angle) * along


def plate_at(conveyor: Conveyor, t: float) -> tuple[float, float, float]:
    """Height and velocity of the plate normal to the track, and its velocity along it (m, m/s)."""
    omega = 2.0 * math.pi * conveyor.frequency
    theta = omega * t + conveyor.psi0
    z, vz, vx = math.cos(theta), math.sin(theta), math.sin(theta + conveyor.phase_shift)
    for order, along, along_phase, normal, normal_phase in conveyor.harmonics:
        z += normal / order**2 * math.cos(order * theta + normal_phase)
        vz += normal / order * math.sin(order * theta + normal_phase)
        vx += along / order * math.sin(order * theta + along_phase)
    a_z, a_x = conveyor.acceleration * math.sin(conveyor.angle), conveyor.acceleration * math.cos(conveyor.angle)
    return -a_z / omega**2 * z, a_z / omega * vz, a_x / omega * vx


def reference_states(conveyor: Conveyor, start: Start, times: np.ndarray) -> dict[str, np.ndarray]:
    """x, z (m), vx, vz (m/s) at increasing `times` (s), all of the shape (n,).

    DOP853 stops where the equations of motion change: where the part lands or leaves, where the contact begins or ends
    to pull (without `allow`), and where the part begins or ends to stick. An event is a crossing in one direction, so
    the zero that has just been found, which may have either sign by rounding, is not found again.
    """
    stiffness, damping = conveyor.stiffness / conveyor.mass, conveyor.damping / conveyor.mass
    gravity = conveyor.gravity * math.cos(conveyor.inclination)
    downhill = conveyor.gravity * math.sin(conveyor.inclination)
    static_friction = conveyor.friction if conveyor.static_friction is None else conveyor.static_friction

    def force(t, y, *_):
        """F_c/m (m/s²) of spring and damper."""
        height, rise, _ = plate_at(conveyor, t)
        return stiffness * max(height - y[2], 0.0) ** conveyor.exponent + damping * (rise - y[3])

    def pull(t):
        """Acceleration (m/s²) that friction must give to a part that sticks."""
        return accelerations(conveyor, t)[1] + downhill

    def rates(t, y, touching, pressed, sigma):
        """Of the state y: x, ẋ, z and ż (m, m/s)."""
        push = force(t, y) if touching and (pressed or conveyor.tension == "frictionless") else 0.0
        if not (touching and pressed):
            rub = 0.0
        elif sigma == 0.0:
            rub = pull(t)
        else:
            rub = sigma * conveyor.friction * push
        return [y[1], rub - downhill, y[3], push - gravity]

    def gap(t, y, *_):
        return y[2] - plate_at(conveyor, t)[0]

    def slip(t, y, *_):
        return plate_at(conveyor, t)[2] - y[1]

    def grip(t, y, *_):
        """What static friction can give (m/s²) beyond what a part that sticks needs."""
        return static_friction * force(t, y) - abs(pull(t))

    gap.terminal = force.terminal = slip.terminal = grip.terminal = True
    grip.direction = -1.0
    height, rise, _ = plate_at(conveyor, 0.0)
    begin, y = 0.0, np.array([0.0, 0.0, height if start.z == "conveyor" else start.z, start.vz])
    # A part on the plate stays there if it moves or else accelerates towards it.
    approach = (gap(begin, y), y[3] - rise, -gravity - accelerations(conveyor, begin)[0])
    touching = approach <= (0.0, 0.0, 0.0)
    # The contact rubs and, with `clip`, pushes only while the part is pressed against the plate.
    pressed = conveyor.tension == "allow" or force(begin, y) >= 0.0
    # The sign of the slip, or 0 while the part sticks. If there is no slip at the start, its event decides at once.
    sigma = math.copysign(1.0, slip(begin, y))
    found = []  # the states (4,) at the first times
    while len(found) < len(times):
        gap.direction, force.direction, slip.direction = 1.0 if touching else -1.0, -1.0 if pressed else 1.0, -sigma
        events = [gap]
        if touching and conveyor.tension != "allow":
            events.append(force)
        if touching and pressed:
            events.append(slip if sigma else grip)
        solved = solve_ivp(
            *(rates, (begin, times[-1]), y, "DOP853"),
            t_eval=times[len(found) :],
            args=(touching, pressed, sigma),
            events=events,
            rtol=2.3e-14,
            atol=1e-17,
            # A first step as long as the others would step over a short flight or slip.
            first_step=min(1e-6 / conveyor.frequency, times[-1] - begin),
            max_step=0.01 / conveyor.frequency,
        )
        assert solved.success, solved.message
        found.extend(np.transpose(solved.y))
        for event, roots, states in zip(events, solved.t_events, solved.y_events, strict=True):
            if not roots.size:
                continue
            begin, y = roots[0], states[0]
            if event is gap:
                touching, pressed = not touching, True
            elif event is force:
                pressed = not pressed
            if event in (gap, force):
                sigma = math.copysign(1.0, slip(begin, y))
            elif event is grip or grip(begin, y) < 0.0:
                sigma = math.copysign(1.0, pull(begin))
            else:
                sigma = 0.0
    return dict(zip(("x", "vx", "z", "vz"), np.transpose(found), strict=True))


def reference_mean_velocity(conveyor: Conveyor, start: Start, duration: float) -> float:
    """Mean velocity (m/s) over the last quarter of the duration (s)."""
    x = reference_states(conveyor, start, np.array([0.75 * duration, duration]))["x"]
    return (x[1] - x[0]) / (0.25 * duration)
