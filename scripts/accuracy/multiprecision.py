"""The motion in arithmetic of many digits: a reference that shares no code, step or rounding with the solver.

Taylor series of Eqs. 7 and 11 in contact (tension = allow), a parabola in flight. The spring's force grows with the
power 1.5 of the depth, so that steps shrink with it, and begin and end CLOSE to the surface. Numbers are midpoints of
python-flint's balls. Made for motions that are off the plate for a good part of a cycle, as in the jumping scene.
"""

from collections.abc import Callable
from dataclasses import asdict

import numpy as np
from flint import arb, ctx

from conveyor.solver.model import Conveyor, Start

ORDER = 24
CLOSE = 1e-12  # m: shallower than that, the spring changes the velocity by less than one part in 1e18
INSIDE = 4  # places within a step, and
SCAN = 400  # within a cycle of flight, at which events are looked for


def root(function: Callable, low: arb, high: arb) -> arb:
    """The zero between two places at which a function has different signs, by the Illinois method."""
    f_low, f_high = function(low), function(high)
    for _ in range(300):
        place = (high - f_high * (high - low) / (f_high - f_low)).mid()
        found = function(place)
        if found == 0 or place in (low, high):
            break
        # The value at an end that stays is halved.
        low, f_low = (high, f_high) if (found > 0) != (f_high > 0) else (low, f_low / 2)
        high, f_high = place, found
    return place


def horner(coefficients: list[arb], at: arb) -> arb:
    total = arb(0)
    for one in reversed(coefficients):
        total = total * at + one
    return total.mid()


class Motion:
    """A part on its way: t, x, ẋ, z, ż, and the sign of its slip, 0 for stick."""

    def __init__(self, conveyor: Conveyor, start: Start, digits: int):
        ctx.dps = self.digits = digits
        self.p = {name: arb(one) for name, one in asdict(conveyor).items() if isinstance(one, float)}
        self.omega = 2 * arb.pi() * self.p["frequency"]
        self.a_z = self.p["acceleration"] * self.p["angle"].sin()
        self.a_x = self.p["acceleration"] * self.p["angle"].cos()
        self.t, self.x, self.vx, self.vz = arb(0), arb(0), arb(0), arb(start.vz)
        self.z = self.plate(self.t)[0] if start.z == "conveyor" else arb(start.z)
        self.slip = 0
        self.events: list[float] = []

    def plate(self, t: arb) -> tuple[arb, arb, arb, arb]:
        """z_s, ż_s, ẋ_s and ẍ_s."""
        phase = self.omega * t + self.p["psi0"]
        sine, cosine = phase.sin(), phase.cos()
        return (
            -self.a_z / self.omega**2 * cosine,
            self.a_z / self.omega * sine,
            self.a_x / self.omega * sine,
            self.a_x * cosine,
        )

    def fly(self, end: arb) -> tuple[arb, Callable]:
        """The time of the next impact, or `end`, and the state (x, ẋ, z, ż) up to it as a function of time."""
        t, x, vx, z, vz, g = self.t, self.x, self.vx, self.z, self.vz, self.p["gravity"]

        def state(now):
            tau = now - t
            return x + vx * tau, vx, z + vz * tau - g * tau**2 / 2, vz - g * tau

        def gap(now):
            return (state(now)[2] - self.plate(now)[0]).mid()

        spacing = 1 / (SCAN * self.p["frequency"])
        low, high = t, min((t + spacing).mid(), end)
        while gap(high) > 0 and high < end:
            low, high = high, min((high + spacing).mid(), end)
        return (root(gap, low, high) if gap(high) <= 0 else end), state

    def series(self, depth: arb, speed: arb) -> tuple[list[arb], list[arb], list[arb]]:
        """Taylor coefficients of the depth, its rate and F_c/m from the time t on."""
        stiffness, damping = (self.p[name] / self.p["mass"] for name in ("stiffness", "damping"))
        exponent, phase = self.p["exponent"], self.omega * self.t + self.p["psi0"]
        deep, fast, spring, force, turn = [depth], [speed], [], [], self.a_z
        derivatives = (phase.cos(), -phase.sin(), -phase.cos(), phase.sin())
        for n in range(ORDER):
            if n == 0:
                spring.append(depth**exponent)
            else:
                terms = [(k * exponent - (n - k)) * deep[k] * spring[n - k] for k in range(1, n + 1)]
                spring.append((sum(terms, arb(0)) / (n * depth)).mid())
            force.append((stiffness * spring[n] + damping * fast[n]).mid())
            pull = turn * derivatives[n % 4] + (self.p["gravity"] if n == 0 else 0)
            deep.append((fast[n] / (n + 1)).mid())
            fast.append(((pull - force[n]) / (n + 1)).mid())
            turn = turn * self.omega / (n + 1)
        return deep, fast, force

    def touch(self, end: arb) -> tuple[arb, Callable, int | None]:
        """The end of a step in contact, the state up to it, and the sign of the slip that begins there, if one does."""
        t, x, vx, slip = self.t, self.x, self.vx, self.slip
        zs, vzs, _, _ = self.plate(t)
        depth, speed = (zs - self.z).mid(), (vzs - self.vz).mid()
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
                x_now, vx_now = x + vx * tau + tau**2 * horner(path, tau), vx + tau * horner(rate, tau)
            else:
                swing = (self.omega * t + self.p["psi0"]).cos() - (self.omega * now + self.p["psi0"]).cos()
                x_now, vx_now = x + self.a_x / self.omega**2 * swing, vx_s
            return x_now, vx_now, z - horner(deep, tau), vz - horner(fast, tau)

        def margin(now):
            """Of the mode: the slip in its direction, or what friction can hold beyond what stick needs."""
            _, _, vx_s, ax_s = self.plate(now)
            if slip:
                return (slip * (vx_s - state(now)[1])).mid()
            return (friction * horner(force, now - t) - abs(ax_s)).mid()

        step = min(arb(step), end - t).mid()
        places = [(t + step * k / INSIDE).mid() for k in range(1, INSIDE + 1)]
        before = t
        for place in places:
            if margin(place) < 0:
                now = root(margin, before, place) if margin(before) > 0 else place
                _, _, _, ax_s = self.plate(now)
                away = 1 if ax_s > 0 else -1
                held = friction * horner(force, now - t) - abs(ax_s) >= 0
                return now, state, (0 if slip and held else away)
            before = place
        return places[-1], state, None

    def graze(self) -> None:
        """Pass between the surface and the depth CLOSE, inwards after an impact and outwards before a separation."""
        zs, vzs, _, _ = self.plate(self.t)
        depth, speed = (zs - self.z).mid(), (vzs - self.vz).mid()
        target = arb(CLOSE) if speed > 0 else arb(0)
        tau = (target - depth) / speed
        for _ in range(3):
            now = self.t + tau
            damping = self.p["damping"] / self.p["mass"]
            lift = self.a_z * (self.omega * (self.t + tau / 2) + self.p["psi0"]).cos()
            pull = self.p["gravity"] + lift - damping * speed
            tau = ((target - depth) / (speed + pull * tau / 2)).mid()
        force = damping * (speed + pull * tau / 2)
        self.x = (self.x + self.vx * tau).mid()
        self.vx = (self.vx + self.slip * self.p["friction"] * force * tau).mid()
        self.t = now.mid()
        zs, vzs, _, _ = self.plate(self.t)
        self.z, self.vz = (zs - target).mid(), (vzs - speed - pull * tau).mid()


def follow(conveyor: Conveyor, start: Start, times: np.ndarray, digits: int) -> tuple[np.ndarray, list[float]]:
    """States x, ẋ, z, ż at ascending times (s), shape (n, 4), and the times of impacts and separations (s).

    The part starts above the plate. Values are rounded to double precision at the end.

    Raises
    ------
    ValueError
        if the track rises, the plate moves along an ellipse or the static friction is larger than the friction
    """
    is_paper_model = conveyor.inclination == conveyor.phase_shift == 0.0
    if not is_paper_model or conveyor.static_friction not in (None, conveyor.friction):
        raise ValueError("the reference of many digits knows neither inclination, phase_shift nor static_friction")
    motion, samples, contact = Motion(conveyor, start, digits), [], False
    end = arb(float(times[-1]))
    while motion.t < end:
        if contact:
            now, state, slip = motion.touch(end)
        else:
            now, state = motion.fly(end)
            slip = None
        while len(samples) < len(times) and arb(float(times[len(samples)])) <= now:
            samples.append([float(one) for one in state(arb(float(times[len(samples)])))])
        motion.x, motion.vx, motion.z, motion.vz = (one.mid() for one in state(now))
        motion.t = now
        if now >= end:
            break
        zs, vzs, vxs, _ = motion.plate(now)
        if not contact:
            contact = True
            motion.events.append(float(now))
            motion.slip = 1 if vxs > motion.vx else -1
            motion.graze()
            continue
        if slip is not None:
            motion.slip = slip
        if float(zs - motion.z) < CLOSE and motion.vz > vzs:
            motion.graze()
            motion.events.append(float(motion.t))
            contact = False
    return np.array(samples), motion.events
