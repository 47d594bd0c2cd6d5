"""Trajectories in multiprecision arithmetic: a reference that shares no code, step or rounding with the solver.

Taylor series of Eqs. 7 and 11 in contact (tension = allow), a parabola in flight. The force of the spring is not smooth
at the surface, so that steps shrink with the depth, and contact begins and ends at the depth CLOSE. Suitable for
motions with a flight in each cycle, as in the jumping scene.
"""

from collections.abc import Callable
from dataclasses import asdict
from itertools import pairwise

import numpy as np
from mpmath import mp, mpf

from conveyor import Conveyor, Start

ORDER = 24
CLOSE = 1e-12  # m: in contacts shallower than this, the spring changes the velocity by less than one part in 1e18
INSIDE = 4  # checks for events in a step
SCAN = 400  # checks for an impact in a cycle of flight


class Motion:
    """The current state of a part: t, x, ẋ, z, ż, and the sign of its slip, 0 for stick."""

    def __init__(self, conveyor: Conveyor, start: Start, digits: int):
        mp.dps = self.digits = digits
        self.p = {name: mpf(one) for name, one in asdict(conveyor).items() if isinstance(one, float)}
        self.omega = 2 * mp.pi * self.p["frequency"]
        self.a_z = self.p["acceleration"] * mp.sin(self.p["angle"])
        self.a_x = self.p["acceleration"] * mp.cos(self.p["angle"])
        self.t, self.x, self.vx, self.vz = mpf(0), mpf(0), mpf(0), mpf(start.vz)
        self.z = self.plate(self.t)[0] if start.z == "conveyor" else mpf(start.z)
        self.slip = 0
        self.events: list[float] = []

    def plate(self, t: mpf) -> tuple[mpf, mpf, mpf, mpf]:
        """z_s, ż_s, ẋ_s and ẍ_s."""
        phase = self.omega * t + self.p["psi0"]
        cosine, sine = mp.cos_sin(phase)
        return (
            -self.a_z / self.omega**2 * cosine,
            self.a_z / self.omega * sine,
            self.a_x / self.omega * sine,
            self.a_x * cosine,
        )

    def fly(self, end: mpf) -> tuple[mpf, Callable]:
        """The time of the next impact, at most `end`, and the state (x, ẋ, z, ż) as a function of time until then."""
        t, x, vx, z, vz, g = self.t, self.x, self.vx, self.z, self.vz, self.p["gravity"]

        def state(now):
            tau = now - t
            return x + vx * tau, vx, z + vz * tau - g * tau**2 / 2, vz - g * tau

        def gap(now):
            return state(now)[2] - self.plate(now)[0]

        spacing = 1 / (SCAN * self.p["frequency"])
        low, high = t, min(t + spacing, end)
        while gap(high) > 0 and high < end:
            low, high = high, min(high + spacing, end)
        return (mp.findroot(gap, (low, high), solver="anderson") if gap(high) <= 0 else end), state

    def series(self, depth: mpf, speed: mpf) -> tuple[list[mpf], list[mpf], list[mpf]]:
        """Taylor coefficients of the depth, its rate and F_c/m around the current time."""
        stiffness, damping = (self.p[name] / self.p["mass"] for name in ("stiffness", "damping"))
        exponent, phase = self.p["exponent"], self.omega * self.t + self.p["psi0"]
        deep, fast, spring, force, turn = [depth], [speed], [depth**exponent], [], self.a_z
        cosine, sine = mp.cos_sin(phase)
        derivatives = (cosine, -sine, -cosine, sine)
        for n in range(ORDER):
            force.append(stiffness * spring[n] + damping * fast[n])
            pull = turn * derivatives[n % 4] + (self.p["gravity"] if n == 0 else 0)
            deep.append(fast[n] / (n + 1))
            # From depth (depth^p)' = p depth' depth^p; a coefficient of a product of series is a scalar product.
            rising, falling = mp.fdot(fast, spring[n::-1]), mp.fdot(deep[1:], spring[n::-1])
            fast.append((pull - force[n]) / (n + 1))
            turn = turn * self.omega / (n + 1)
            spring.append(((exponent + 1) * rising - (n + 1) * falling) / ((n + 1) * depth))
        return deep, fast, force

    def step_in_contact(self, end: mpf) -> tuple[mpf, Callable, int | None]:
        """The end of a step in contact, the state as a function of time, and the sign of a slip that begins at its end.

        The sign is 0 if the part begins to stick, and None without a change.
        """
        t, x, vx, slip = self.t, self.x, self.vx, self.slip
        zs, vzs, _, _ = self.plate(t)
        depth, speed = zs - self.z, vzs - self.vz
        deep, fast, force = self.series(depth, speed)
        last = [abs(float(one)) for one in deep[-2:]]
        size = abs(float(depth))
        step = min(
            (10.0**-self.digits * size / one) ** (1 / n) for n, one in zip((ORDER - 1, ORDER), last, strict=True)
        )
        friction = self.p["friction"]
        rate = [slip * friction * one / (n + 1) for n, one in enumerate(force)]
        path = [one / (n + 2) for n, one in enumerate(rate)]

        def state(now):
            tau = now - t
            z, vz, vx_s, _ = self.plate(now)
            if slip:
                x_now, vx_now = x + vx * tau + tau**2 * mp.polyval(path, tau, asc=True), slipping_speed(tau)
            else:
                swing = mp.cos(self.omega * t + self.p["psi0"]) - mp.cos(self.omega * now + self.p["psi0"])
                x_now, vx_now = x + self.a_x / self.omega**2 * swing, vx_s
            return x_now, vx_now, z - mp.polyval(deep, tau, asc=True), vz - mp.polyval(fast, tau, asc=True)

        def slipping_speed(tau):
            return vx + tau * mp.polyval(rate, tau, asc=True)

        def margin(now):
            """Positive while the mode lasts: slip speed, or in stick the largest friction minus the needed one."""
            _, _, vx_s, ax_s = self.plate(now)
            if slip:
                return slip * (vx_s - slipping_speed(now - t))
            return friction * mp.polyval(force, now - t, asc=True) - abs(ax_s)

        step = min(mpf(step), end - t)
        for before, place in pairwise(t + step * k / INSIDE for k in range(INSIDE + 1)):
            if margin(place) < 0:
                now = mp.findroot(margin, (before, place), solver="anderson") if margin(before) > 0 else place
                _, _, _, ax_s = self.plate(now)
                away = 1 if ax_s > 0 else -1
                held = friction * mp.polyval(force, now - t, asc=True) - abs(ax_s) >= 0
                return now, state, (0 if slip and held else away)
        return place, state, None

    def cross_surface(self) -> None:
        """Move between the surface and the depth CLOSE: inwards after an impact, outwards before a separation."""
        zs, vzs, _, _ = self.plate(self.t)
        depth, speed = zs - self.z, vzs - self.vz
        target = mpf(CLOSE) if speed > 0 else mpf(0)
        tau = (target - depth) / speed
        for _ in range(3):
            now = self.t + tau
            damping = self.p["damping"] / self.p["mass"]
            lift = self.a_z * mp.cos(self.omega * (self.t + tau / 2) + self.p["psi0"])
            pull = self.p["gravity"] + lift - damping * speed
            tau = (target - depth) / (speed + pull * tau / 2)
        force = damping * (speed + pull * tau / 2)
        self.x = self.x + self.vx * tau
        self.vx = self.vx + self.slip * self.p["friction"] * force * tau
        self.t = now
        zs, vzs, _, _ = self.plate(self.t)
        self.z, self.vz = zs - target, vzs - speed - pull * tau


def simulate(conveyor: Conveyor, start: Start, times: np.ndarray, digits: int) -> tuple[np.ndarray, list[float]]:
    """States x, ẋ, z, ż at ascending times (s), shape (n, 4), and the times of impacts and separations (s).

    The initial position must be above the plate. The results are rounded to double precision.

    Raises
    ------
    ValueError
        if the track rises, the plate moves along an ellipse or the static friction is larger than the friction
    """
    is_paper_model = conveyor.inclination == conveyor.phase_shift == 0.0
    if not is_paper_model or conveyor.static_friction not in (None, conveyor.friction):
        raise ValueError(
            "the multiprecision reference solves the paper's model only; remove inclination, phase_shift and "
            "static_friction from its scene"
        )
    motion, samples, contact = Motion(conveyor, start, digits), [], False
    end = mpf(float(times[-1]))
    while motion.t < end:
        if contact:
            now, state, slip = motion.step_in_contact(end)
        else:
            now, state = motion.fly(end)
            slip = None
        while len(samples) < len(times) and mpf(float(times[len(samples)])) <= now:
            samples.append([float(one) for one in state(mpf(float(times[len(samples)])))])
        motion.x, motion.vx, motion.z, motion.vz = state(now)
        motion.t = now
        if now >= end:
            break
        zs, vzs, vxs, _ = motion.plate(now)
        if not contact:
            contact = True
            motion.events.append(float(now))
            motion.slip = 1 if vxs > motion.vx else -1
            motion.cross_surface()
            continue
        if slip is not None:
            motion.slip = slip
        if float(zs - motion.z) < CLOSE and motion.vz > vzs:
            motion.cross_surface()
            motion.events.append(float(motion.t))
            contact = False
    return np.array(samples), motion.events
