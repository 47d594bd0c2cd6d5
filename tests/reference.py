"""A slow, independent solution of the model with SciPy, with which tests compare the fast solvers.

Explicit modes (flight, contact; loaded or not; slip forward, slip backward, stick) with events between them. Contact is
integrated by DOP853 in plate coordinates: gap q, q̇, displacement u = x_p - x_s and slip velocity s = ẋ_s - ẋ_p, which
keeps the digits of a penetration of micrometres. Flight has a closed form; a dense scan finds its end.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize_scalar

from conveyor import Conveyor, Start

STEPS_PER_PERIOD = 200
MAX_SEGMENTS = 100_000


@dataclass(frozen=True)
class Plate:
    """Motion of the plate: amplitudes of z_s (m), x_s (m), the circular frequency (1/s), both phases at t = 0."""

    z_amplitude: float
    x_amplitude: float
    omega: float
    psi0: float
    x_psi0: float

    @classmethod
    def of(cls, conveyor: Conveyor) -> "Plate":
        omega = 2.0 * math.pi * conveyor.frequency
        a_z = conveyor.acceleration * math.sin(conveyor.angle)
        a_x = conveyor.acceleration * math.cos(conveyor.angle)
        return cls(a_z / omega**2, a_x / omega**2, omega, conveyor.psi0, conveyor.psi0 + conveyor.phase_shift)

    def shape(self, t, psi0, derivative):
        """The derivative of -cos(ωt + ψ0) with respect to t of order 0, 1 or 2."""
        phase = self.omega * t + psi0
        return (-np.cos(phase), self.omega * np.sin(phase), self.omega**2 * np.cos(phase))[derivative]

    def z(self, t, derivative=0):
        return self.z_amplitude * self.shape(t, self.psi0, derivative)

    def x(self, t, derivative=0):
        return self.x_amplitude * self.shape(t, self.x_psi0, derivative)


def gravity_of(conveyor):
    """The components of gravity normal to the track and down along it, m/s²."""
    return conveyor.gravity * math.cos(conveyor.inclination), conveyor.gravity * math.sin(conveyor.inclination)


def pull_of(conveyor, plate, t):
    """Acceleration (m/s²) along the track that the contact must give to a part that sticks."""
    return plate.x(t, 2) + gravity_of(conveyor)[1]


def grip_of(conveyor, force):
    """Largest acceleration (m/s²) along the track that the contact can give to a part that sticks, from F_c/m."""
    coefficient = conveyor.friction if conveyor.static_friction is None else conveyor.static_friction
    return coefficient * force


@dataclass(frozen=True)
class Mode:
    """`loaded`: the contact rubs (and, with `clip`, pushes); `slip`: sign of s while it slips, 0 while it sticks."""

    contact: bool
    loaded: bool = False
    slip: int = 0


@dataclass(frozen=True)
class Segment:
    """A stretch of time in one mode; `state(t)` gives (q, q̇, u, s) for begin ≤ t ≤ end."""

    begin: float
    end: float
    mode: Mode
    state: Callable


def elastic_and_viscous(conveyor, q, gap_velocity):
    """Contact acceleration of spring and damper, m/s², of either sign."""
    spring = conveyor.stiffness * np.maximum(-q, 0.0) ** conveyor.exponent
    return (spring - conveyor.damping * gap_velocity) / conveyor.mass


def choose_mode(conveyor, plate, t, state, loaded=None, slip=None):
    """The mode that follows `state`; `loaded` and `slip` are given if an event has just determined them."""
    q, gap_velocity, _, s = state
    relative_gravity = -gravity_of(conveyor)[0] - plate.z(t, 2)
    if q > 0.0 or (q == 0.0 and (gap_velocity > 0.0 or (gap_velocity == 0.0 and relative_gravity > 0.0))):
        return Mode(contact=False)
    force = elastic_and_viscous(conveyor, q, gap_velocity)
    if loaded is None:
        loaded = conveyor.tension == "allow" or force > 0.0 or (force == 0.0 and gap_velocity <= 0.0)
    if slip is None:
        pull = pull_of(conveyor, plate, t)
        if s != 0.0:
            slip = int(math.copysign(1.0, s))
        elif abs(pull) <= grip_of(conveyor, force):
            slip = 0
        else:
            slip = int(math.copysign(1.0, pull))
    return Mode(True, loaded, slip)


def accelerations(conveyor, plate, mode, t, q, gap_velocity):
    """(F_r/m, F_c/m) in m/s² in the given mode."""
    if not mode.contact:
        return 0.0 * t, 0.0 * t
    force = elastic_and_viscous(conveyor, q, gap_velocity)
    if not mode.loaded:
        return 0.0 * t, (0.0 * t if conveyor.tension == "clip" else force)
    return (mode.slip * conveyor.friction * force if mode.slip else pull_of(conveyor, plate, t)), force


def flight_segment(conveyor, plate, mode, begin, state, duration):
    """Ballistic flight from `begin` to the first root of the gap, found by a scan with refined minima."""
    q0, gap_velocity0, u0, s0 = state
    vz0 = gap_velocity0 + plate.z(begin, 1)
    vx0 = plate.x(begin, 1) - s0
    normal, downhill = gravity_of(conveyor)

    def motion(t):
        tau = t - begin
        # The differences z_s(t) - z_s(t0) and x_s(t) - x_s(t0) without cancellation.
        half = 0.5 * plate.omega * tau
        chord, x_chord = (
            2.0 * np.sin(plate.omega * begin + psi0 + half) * np.sin(half) for psi0 in (plate.psi0, plate.x_psi0)
        )
        q = q0 + vz0 * tau - 0.5 * normal * tau**2 - plate.z_amplitude * chord
        u = u0 + vx0 * tau - 0.5 * downhill * tau**2 - plate.x_amplitude * x_chord
        return np.array([q, vz0 - normal * tau - plate.z(t, 1), u, plate.x(t, 1) - vx0 + downhill * tau])

    def gap(t):
        return motion(t)[0]

    spacing = 1.0 / (STEPS_PER_PERIOD * conveyor.frequency)
    ladder = spacing * 2.0 ** np.arange(-20.0, 0.0)
    previous, left = None, None
    count = 0
    while True:
        tau = ladder[count] if count < len(ladder) else spacing * (count - len(ladder) + 1)
        right = min(begin + tau, duration)
        value = gap(right)
        if left is not None and value <= 0.0:
            end = brentq(gap, left, right, xtol=1e-16, rtol=1e-15)
            break
        if previous is not None and gap(left) < min(gap(previous), value):
            lowest = minimize_scalar(gap, bounds=(previous, right), method="bounded", options={"xatol": 1e-13}).x
            if gap(lowest) <= 0.0:
                end = brentq(gap, previous, lowest, xtol=1e-16, rtol=1e-15)
                break
        if right == duration:
            return Segment(begin, duration, mode, motion), motion(duration), {}
        if value > 0.0:
            previous, left = left, right
        count += 1
    landed = motion(end)
    landed[0] = 0.0
    return Segment(begin, end, mode, motion), landed, {}


def contact_segment(conveyor, plate, mode, begin, state, duration, rtol):
    """Contact from `begin` to the next event: the segment, the state at the event, and the mode that it determines."""

    normal, downhill = gravity_of(conveyor)

    def rates(t, y):
        q, gap_velocity, _, s = y
        rub, push = accelerations(conveyor, plate, mode, t, q, gap_velocity)
        return [gap_velocity, push - normal - plate.z(t, 2), -s, plate.x(t, 2) + downhill - rub]

    def separation(t, y):
        return y[0]

    def deepest(t, y):
        return y[1]

    def load_change(t, y):
        return elastic_and_viscous(conveyor, y[0], y[1])

    def reversal(t, y):
        return y[3]

    def fastest(t, y):
        return rates(t, y)[3]

    def break_away(t, y):
        return grip_of(conveyor, elastic_and_viscous(conveyor, y[0], y[1])) - abs(pull_of(conveyor, plate, t))

    # An event function that starts at zero counts only after it has changed sign; its first zero has been handled.
    events = [(deepest if state[0] == 0.0 else separation, 1.0)]
    if conveyor.tension != "allow":
        events.append((load_change, -1.0 if mode.loaded else 1.0))
    if mode.loaded and mode.slip:
        events.append((fastest if state[3] == 0.0 else reversal, -mode.slip))
    elif mode.loaded:
        events.append((break_away, -1.0))
    for function, direction in events:
        function.terminal, function.direction = True, direction

    solution = solve_ivp(
        rates,
        (begin, duration),
        state,
        method="DOP853",
        rtol=rtol,
        atol=rtol * np.array([1e-6, 1e-2, 1e-4, 1e-2]),
        max_step=1.0 / (STEPS_PER_PERIOD * conveyor.frequency),
        events=[function for function, _ in events],
        dense_output=True,
    )
    if solution.status < 0:
        raise RuntimeError(solution.message)
    end, last = solution.t[-1], solution.y[:, -1].copy()
    segment = Segment(begin, end, mode, solution.sol)
    decided = {}
    for (function, _), times in zip(events, solution.t_events, strict=True):
        if not len(times):
            continue
        if function is separation:
            last[0] = 0.0
        elif function is load_change:
            decided["loaded"] = not mode.loaded
        elif function is reversal:
            last[3] = 0.0
        elif function is break_away:
            decided["slip"] = int(math.copysign(1.0, pull_of(conveyor, plate, end)))
    return segment, last, decided


def reference_segments(conveyor: Conveyor, start: Start, duration: float, rtol: float = 1e-13) -> list[Segment]:
    """The whole motion from 0 to `duration` (s) as consecutive segments."""
    plate = Plate.of(conveyor)
    q0 = 0.0 if start.z == "conveyor" else start.z - plate.z(0.0)
    state = np.array([q0, start.vz - plate.z(0.0, 1), -plate.x(0.0), plate.x(0.0, 1)])
    t, decided, segments = 0.0, {}, []
    while t < duration:
        if len(segments) == MAX_SEGMENTS:
            raise RuntimeError(f"more than {MAX_SEGMENTS} segments until t = {t} s")
        mode = choose_mode(conveyor, plate, t, state, **decided)
        if mode.contact:
            segment, state, decided = contact_segment(conveyor, plate, mode, t, state, duration, rtol)
        else:
            segment, state, decided = flight_segment(conveyor, plate, mode, t, state, duration)
        segments.append(segment)
        t = segment.end
    return segments


def states_at(conveyor: Conveyor, segments: list[Segment], times: np.ndarray) -> dict[str, np.ndarray]:
    """Arrays x, z (m), vx, vz (m/s), contact_force, friction_force (N) of the shape of `times` (s)."""
    plate = Plate.of(conveyor)
    times = np.asarray(times, dtype=np.float64)
    ends = np.array([segment.end for segment in segments])
    rows = np.empty((times.size, 6))
    for k, t in enumerate(times.ravel()):
        segment = segments[min(np.searchsorted(ends, t), len(segments) - 1)]
        q, gap_velocity, u, s = segment.state(t)
        rub, push = accelerations(conveyor, plate, segment.mode, t, q, gap_velocity)
        rows[k] = (
            u + plate.x(t),
            plate.x(t, 1) - s,
            q + plate.z(t),
            gap_velocity + plate.z(t, 1),
            conveyor.mass * push,
            conveyor.mass * rub,
        )
    names = ("x", "vx", "z", "vz", "contact_force", "friction_force")
    return {name: rows[:, k].reshape(times.shape) for k, name in enumerate(names)}


def reference_states(conveyor: Conveyor, start: Start, times: np.ndarray, rtol: float = 1e-13) -> dict[str, np.ndarray]:
    """States and forces at `times` (s), by the names and units of `states_at`."""
    segments = reference_segments(conveyor, start, float(np.max(times)), rtol)
    return states_at(conveyor, segments, times)


def reference_mean_velocity(
    conveyor: Conveyor, start: Start, duration: float, last: float = 0.25, rtol: float = 1e-13
) -> float:
    """(x(T) - x((1 - last) T)) / (last T) in m/s."""
    x = reference_states(conveyor, start, np.array([(1.0 - last) * duration, duration]), rtol)["x"]
    return (x[1] - x[0]) / (last * duration)
