"""Comparison of the solver with published theory (`accuracy.closed_forms`).

Isolated impacts are computed without gravity on a plate at rest. A rigid ball is the limit of a stiff linear contact
whose damping keeps the coefficient of restitution constant.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.optimize import minimize_scalar

from conveyor import Conveyor, Start, continue_orbit, parameter_table, periodic_orbit, plate_motion, simulate
from conveyor.analysis.bifurcations.doubling_cascade import FEIGENBAUM
from conveyor.methods import event_driven
from conveyor.parameters import normal_gravity
from conveyor_pipeline.common import fields, grid
from conveyor_pipeline.common.rule_log import JobError
from conveyor_pipeline.study.accuracy import closed_forms

TABLES = {
    "theory": (
        fields.text("kind", "rigid, cascade, impact or sliding, which have different accepted differences"),
        fields.text("quantity", "compared quantity"),
        fields.text("case", "parameters"),
        fields.text("unit", "unit of theory, computed and error"),
        fields.number("theory", "see unit", "published value or closed form"),
        fields.number("computed", "see unit", "value from the solver"),
        fields.number("error", "see unit", "estimated error of the computed value; null if it is not estimated"),
        fields.number("difference", "1", "relative difference of computed and theory"),
        fields.number("accepted", "1", "largest accepted relative difference"),
        fields.text("source", "source of the theory; the page lists the sources"),
    ),
}

RESTITUTION = (0.2, 0.5, 0.8)  # of a rigid ball on a vibrating plate
STIFFNESS = (1e8, 1e9, 1e10)  # N/m, of linear contacts from which the rigid limit is extrapolated
SPEED = (0.05, 0.35, 1.0)  # m/s, of isolated impacts
# Largest accepted relative differences, limited by extrapolation, by the last change of the stored ratios, by rounding,
# and by the friction, which the theory of sliding takes as small.
ACCEPTED = {"rigid": 1e-8, "cascade": 1e-5, "impact": 1e-9, "sliding": 1e-3}
TOLERANCE = 1e-14  # of contact steps
LIGHT = 1e-5  # dimensionless damping so small that the loss of speed is proportional to it
RUN = 20.0  # duration of a run in durations of an undamped impact
WEAK = 1e-18  # gravity, m/s², that no digit of an impact shows, although the flight behind it still ends
CYCLES = 200  # excitation cycles until a part with a stiff contact is close to its orbit
# Lee, Teng and Hu (2021): Hz, m. The ratio of the displacements and the phases are those of the largest velocity.
LOWER_FREQUENCY, STROKE = 237.5, 54.5e-6
RATIO, PHASES = 0.25, (0.5 * math.pi, -0.5 * math.pi)
SMALL_FRICTION = 0.05
SLIDING_TIME = 8.0  # s, of which the last quarter is a whole number of cycles
FAR_ENOUGH = 1.02  # end of a branch in amplitudes of the first period doubling of a rigid ball


class Impact(NamedTuple):
    """One isolated impact."""

    duration: float  # s
    peak: float  # N, largest contact force
    restitution: float


def simulate_impact(conveyor: Conveyor, speed: float) -> Impact:
    """One impact at a speed (m/s) on a plate at rest, without gravity, by the solver.

    Raises
    ------
    JobError
        if the part has not separated after RUN durations of an undamped impact
    """
    row = parameter_table(conveyor, Start(z=closed_forms.compression(conveyor, speed), vz=-speed))
    row["acceleration"], row["gravity"] = 0.0, WEAK  # less gravity than a Conveyor may have
    end = RUN * closed_forms.undamped_duration(conveyor, speed)
    samples, events = event_driven.follow(row, np.array([end]), TOLERANCE, room=8)
    times = {kind: time for time, kind in events}
    if "separation" not in times:
        raise JobError(f"an impact at {speed:g} m/s does not end within {end:g} s; take less damping")
    begin, separation = times["impact"], times["separation"]

    def push(time: float) -> float:
        return -event_driven.follow(row, np.array([time]), TOLERANCE, room=0)[0]["contact_force"][0]

    peak = -minimize_scalar(push, bounds=(begin, separation), method="bounded", options={"xatol": 1e-9 * end}).fun
    return Impact(separation - begin, peak, samples["vz"][0] / speed)


def linear_contact(model: dict, stiffness: float, restitution: float, **changes: float | str) -> Conveyor:
    """A conveyor with a linear contact of a given stiffness (N/m) and coefficient of restitution."""
    damping = 2.0 * closed_forms.damping_ratio(restitution) * math.sqrt(stiffness * model["mass"])
    contact = {"exponent": 1.0, "stiffness": stiffness, "damping": damping, "tension": "allow"}
    return grid.conveyor_and_start({**model, **contact, **changes})[0]


def stiff_range(model: dict, stiffness: float, restitution: float) -> tuple[float, float]:
    """Range of a_z/g in which a part with a stiff linear contact has a stable orbit with one impact per cycle.

    The ends follow from continuation of the orbit.

    Raises
    ------
    JobError
        if the orbit, its fold or its period doubling is missing
    """
    low, high = closed_forms.rigid_range(restitution)
    gravity = normal_gravity(model)
    vertical = math.sin(model["angle"])
    middle = 0.5 * (low + high)
    # On the rigid orbit, the part leaves with the velocity g T/2, and the plate has the velocity g T (1 - e)/(1 + e)/2.
    # Half a cycle later, the part is at the top of its flight, g T²/8 higher, and the plate as far below its middle
    # position as it was above. There, no impact passes the phase at which the orbit is followed.
    phase = 2.0 * math.pi - math.asin(low / middle)
    conveyor = linear_contact(model, stiffness, restitution, acceleration=middle * gravity / vertical, psi0=phase)
    plate = plate_motion(conveyor, np.zeros(1))["z"][0]
    start = Start(z=gravity / (8.0 * model["frequency"] ** 2) - plate, vz=0.0)
    orbit = periodic_orbit(conveyor, start, transient=CYCLES)
    if orbit is None or orbit.impacts != 1:
        raise JobError(f"no orbit with one impact per cycle for e = {restitution:g}; take a stiffer contact")
    scale = gravity / vertical
    # Each side only as far as its bifurcation: behind the fold, the unstable orbits are not needed up to the doubling.
    sides = (0.9 * low * scale, orbit.acceleration), (orbit.acceleration, FAR_ENOUGH * high * scale)
    branches = [continue_orbit(orbit, "acceleration", side) for side in sides]
    ends = {point.kind: point.orbit.acceleration / scale for branch in branches for point in branch.bifurcations}
    if not {"fold", "period_doubling"} <= ends.keys():
        raise JobError(f"the branch of e = {restitution:g} has only {sorted(ends)}; take a stiffer contact")
    return ends["fold"], ends["period_doubling"]


def value_at_zero(places: np.ndarray, values: np.ndarray) -> float:
    """Value at 0 of the polynomial through `values` at `places`, shape (n,)."""
    weights = [math.prod(other / (other - place) for other in places if other != place) for place in places]
    return math.fsum(weight * value for weight, value in zip(weights, values, strict=True))


def extrapolate_to_zero(places: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """The value at 0 of the polynomial through all values, and its change without the first one."""
    value = value_at_zero(places, values)
    return value, abs(value - value_at_zero(places[1:], values[1:]))


def rigid_rows(settings: dict) -> Iterator[dict]:
    """Rows of the stable range of a bouncing ball, extrapolated in the duration of an impact, which is as 1/√k."""
    stiffness = np.array(STIFFNESS)
    for restitution in RESTITUTION:
        ranges = np.array([stiff_range(settings["model"], k, restitution) for k in stiffness])
        names = ("least a_z/g of one impact per cycle", "a_z/g of the first period doubling")
        for name, theory, values in zip(names, closed_forms.rigid_range(restitution), ranges.T, strict=True):
            computed, error = extrapolate_to_zero(stiffness**-0.5, values)
            case, source = f"rigid ball, e = {restitution:g}", "Luo and Han 1996"
            yield row("rigid", name, case, "1", theory, computed, source, error)


def cascade_row(cascade: pd.DataFrame) -> dict:
    """The row of Feigenbaum's constant: the last ratio of the cascade, with its last change as the error."""
    ratios = cascade.sort_values("number", kind="stable").ratio.dropna()
    before, last = ratios.iloc[-2:]
    case, source = f"{len(cascade)} period doublings", "Feigenbaum 1978"
    error = abs(last - before)
    return row("cascade", "Feigenbaum's constant", case, "1", FEIGENBAUM, last, source, error)


def impact_rows(settings: dict) -> Iterator[dict]:
    """Rows of duration, peak force and restitution of isolated impacts."""
    model = settings["model"] | {"tension": "allow"}
    damped, _ = grid.conveyor_and_start(model)
    elastic, _ = grid.conveyor_and_start(model | {"damping": 0.0})
    for speed in SPEED:
        simulated = simulate_impact(elastic, speed)
        depth = closed_forms.compression(elastic, speed)
        case = f"undamped, {speed:g} m/s"
        duration = closed_forms.undamped_duration(elastic, speed)
        force = elastic.stiffness * depth**elastic.exponent
        yield row("impact", "duration of an impact", case, "s", duration, simulated.duration, "Hertz 1882")
        yield row("impact", "peak force of an impact", case, "N", force, simulated.peak, "Hertz 1882")
    for speed in SPEED:
        beta = damped.damping / damped.mass * closed_forms.compression(damped, speed) / speed
        theory = closed_forms.reduced_restitution(damped.exponent, beta)
        simulated = simulate_impact(damped, speed)
        case, source = f"F = k δ^p + d δ̇, {speed:g} m/s", "reduced equation, SciPy"
        yield row("impact", "coefficient of restitution", case, "1", theory, simulated.restitution, source)
    speed = SPEED[0]
    unit = elastic.mass * speed / closed_forms.compression(elastic, speed)  # damping with β = 1

    def loss(beta: float) -> float:
        light, _ = grid.conveyor_and_start(model | {"damping": beta * unit})
        return (1.0 - simulate_impact(light, speed).restitution) / beta

    computed, error = extrapolate_to_zero(np.array([2.0 * LIGHT, LIGHT]), np.array([loss(2.0 * LIGHT), loss(LIGHT)]))
    theory = closed_forms.light_loss(elastic.exponent)
    source = "work of the damper"
    name = "loss of speed (1 - e)/β"
    case = "F = k δ^p + d δ̇, β → 0"
    yield row("impact", name, case, "1", theory, computed, source, error)
    for restitution in RESTITUTION:
        clipped = closed_forms.restitution_without_tension(restitution)
        for tension, theory in (("allow", restitution), ("clip", clipped)):
            contact = linear_contact(model, STIFFNESS[0], restitution, tension=tension)
            simulated = simulate_impact(contact, speed)
            case = f"F = k δ + d δ̇, ζ = {closed_forms.damping_ratio(restitution):.3g}, {tension}"
            source = "Schwager and Pöschel 2007"
            yield row("impact", "coefficient of restitution", case, "1", theory, simulated.restitution, source)


def sliding_rows(settings: dict) -> Iterator[dict]:
    """Rows of the velocity of a part that slides on a plate with two frequencies, for both directions."""
    omega = 2.0 * math.pi * LOWER_FREQUENCY
    for phase in PHASES:
        peak, median = closed_forms.two_frequencies(RATIO, phase)
        fundamental = STROKE / peak
        # The acceleration of the second harmonic has four times the ratio of the displacement.
        drive = {"acceleration": fundamental * omega**2, "frequency": LOWER_FREQUENCY, "angle": 0.0}
        drive["harmonics"] = [{"order": 2, "along": 4.0 * RATIO, "along_phase": phase}]
        conveyor, start = grid.conveyor_and_start(
            settings["model"]
            | drive
            | {"friction": SMALL_FRICTION, "static_friction": SMALL_FRICTION, "z0": "conveyor"}
        )
        computed = simulate(conveyor, start, duration=SLIDING_TIME).mean_velocity()
        case = (
            f"{1e6 * STROKE:g} µm, {LOWER_FREQUENCY:g} and {2.0 * LOWER_FREQUENCY:g} Hz, phase {math.degrees(phase):g}°"
        )
        source = "median of the plate's velocity"
        theory = fundamental * omega * median
        yield row("sliding", "velocity of a part that slides", case, "m/s", theory, computed, source)


def row(
    kind: str,
    quantity: str,
    case: str,
    unit: str,
    theory: float,
    computed: float,
    source: str,
    error: float = math.nan,
) -> dict:
    """A row of the table; `kind` selects the accepted difference."""
    return {
        "kind": kind,
        "quantity": quantity,
        "case": case,
        "unit": unit,
        "theory": theory,
        "computed": computed,
        "error": error,
        "difference": abs(computed / theory - 1.0),
        "accepted": ACCEPTED[kind],
        "source": source,
    }


def make(settings: dict, cascade: pd.DataFrame) -> dict[str, list]:
    """The columns of the table of theory, with the table of period doublings."""
    rows = [*rigid_rows(settings), cascade_row(cascade), *impact_rows(settings), *sliding_rows(settings)]
    return fields.columns(rows, TABLES["theory"])
