"""Stability limits of methods with a time step, over stiffness, damping, impact velocity and amplitude."""

import math
from collections.abc import Callable
from functools import cache

import numpy as np
from scipy.optimize import brentq
from scipy.special import beta

from conveyor import DEFAULT_TOLERANCE, Columns, Conveyor, Start, parameter_table, simulate, sweep
from conveyor.methods import fixed_step
from conveyor.parameters import FIXED_STEP_METHODS
from conveyor.progress import progress_bar
from conveyor_pipeline.common import fields
from conveyor_pipeline.study.accuracy.closed_forms import compression, undamped_duration
from conveyor_pipeline.study.accuracy.limits import HEIGHT, PANELS, VELOCITY

TABLES = {
    "stability": (
        fields.text("panel", "the varied quantity: stiffness, damping, impact velocity, or conveyor for the amplitude"),
        fields.text("method", "euler, semi_implicit_euler, rk4, or event"),
        fields.number("x", "s", "time step; null for event"),
        fields.number("y", "see panel", "varied quantity in SI units"),
        fields.text("outcome", "right, wrong state, energy grows or blow-up"),
        fields.number("theory", "s", "theoretical stability limit of the time step; null for none"),
    ),
}

RIGHT, WRONG, GROWS, BLOWS_UP = "right", "wrong state", "energy grows", "blow-up"
STEPS = (2.0e-7, 3.0e-3, 43)  # s; least and largest step, and number of steps
DURATION = 0.5  # s, of the runs of the paper's conveyor
# Linear contact where stiffness (N/m) or damping (N s/m) is not varied: p = 1, for which a theory exists.
CONTACT = {"stiffness": 1.0e5, "damping": 0.3}
TRUTH = 1e-13  # tolerance of the solver as the reference
FAR = 1.0  # m: distance of a part after a blow-up
# Initial compression of a linear contact beyond its static penetration, as a share of it.
PRESSED = 0.5
FOLDINGS = 8.0  # duration of a run at rest, in decay times of the contact
RESTITUTION = 0.05  # largest error of a coefficient of restitution that counts as right


def characteristic(stiffness: float, damping: float, mass: float) -> tuple[complex, complex]:
    """Both roots of λ² + (d/m) λ + k/m (1/s)."""
    root = np.sqrt(complex(0.25 * (damping / mass) ** 2 - stiffness / mass))
    return -0.5 * damping / mass + root, -0.5 * damping / mass - root


def stability_limit(method: str, stiffness: float, damping: float, mass: float) -> float:
    """Largest stable step h (s) of a method in a linear contact with k (N/m), d (N s/m) and m (kg).

    NaN for `event` and for methods without a stability polynomial.
    Semi-implicit Euler: h² k/m + 2 h d/m = 4, near 2/ω. Other methods: |R(hλ)| = 1 with the stability polynomial R;
    explicit Euler: h = d/k for an oscillation, RK4: near 2.78/ω.
    """
    if method == "event":
        return math.nan
    roots = characteristic(stiffness, damping, mass)
    if method == "semi_implicit_euler":
        rate, square = damping / mass, stiffness / mass
        return (math.sqrt(rate * rate + 4.0 * square) - rate) / square
    if fixed_step.GROWTH[method] is None:
        return math.nan
    if method == "euler":
        return min(-2.0 * root.real / abs(root) ** 2 for root in roots)

    def growth(step):
        return max(abs(np.polynomial.Polynomial(fixed_step.GROWTH[method])(step * root)) for root in roots) - 1.0

    # A scan, because the first step with growth may be far below 1/|λ|.
    size = max(map(abs, roots))
    steps = np.geomspace(1e-4, 10.0, 200) / size
    last = next(place for place, step in enumerate(steps) if growth(step) > 0.0)
    return brentq(growth, steps[last - 1], steps[last])


def whole_steps(duration: float, step: float) -> float:
    """A duration (s) rounded up to a whole number of steps (s)."""
    return math.ceil(duration / step - 1e-9) * step


def run_to_end(
    method: str, conveyor: Conveyor, start: Start, duration: float, step: float, tolerance: float = DEFAULT_TOLERANCE
) -> tuple[float, float, float]:
    """Height (m) and velocity (m/s) at the end of a run, and its largest gap (m); `event` uses no step."""
    if method == "event":
        run = simulate(conveyor, start, duration=duration, tolerance=tolerance)
    else:
        run = simulate(conveyor, start, duration=whole_steps(duration, step), method=method, step=step)
    return run.z_end, run.vz_end, run.max_gap


def outcome_at_rest(method: str, step: float, stiffness: float, damping: float) -> str:
    """Outcome for a part that is pressed into a linear contact at rest, beyond its static penetration, and released."""
    conveyor = Conveyor(acceleration=0.0, exponent=1.0, stiffness=stiffness, damping=damping)
    depth = conveyor.mass * conveyor.gravity / stiffness
    slowest = max(root.real for root in characteristic(stiffness, damping, conveyor.mass))
    z, vz, highest = run_to_end(method, conveyor, Start(-(1.0 + PRESSED) * depth), FOLDINGS / -slowest, step)
    if not (math.isfinite(z) and math.isfinite(vz)) or max(abs(z), highest) > FAR:
        return BLOWS_UP
    square = stiffness / conveyor.mass
    energy = 0.5 * vz * vz + 0.5 * square * (min(z, 0.0) + depth) ** 2 + conveyor.gravity * max(z, 0.0)
    if energy > 0.5 * square * (PRESSED * depth) ** 2:
        return GROWS
    return RIGHT if abs(z + depth) < 0.1 * PRESSED * depth else WRONG


def restitution(
    method: str, step: float, speed: float, conveyor: Conveyor, tolerance: float = DEFAULT_TOLERANCE
) -> float:
    """Coefficient of restitution of one impact on a plate at rest; 0 if the part stays, infinity after a blow-up."""
    height = 1e-6
    duration = 4.0 * height / speed + 6.0 * undamped_duration(conveyor, speed)
    z, vz, _ = run_to_end(method, conveyor, Start(height, -speed), duration, step, tolerance)
    if not (math.isfinite(z) and abs(z) < FAR):
        return math.inf
    return math.sqrt(max(vz * vz + 2.0 * conveyor.gravity * (z - height), 0.0)) / speed if z > 0.0 else 0.0


def impact_limit(method: str, conveyor: Conveyor, speed: float) -> float:
    """Stability limit of the step (s) in a Hertz impact.

    Explicit Euler adds the energy Δt ∫ k v² dt to an impact (from its modified equation), and damping dissipates
    d_c ∫ v² dt. The limit is the step at which both are equal. Other methods have the limit at the deepest point.
    """
    stiffness = 1.5 * conveyor.stiffness * math.sqrt(compression(conveyor, speed))
    if method == "euler":
        return conveyor.damping / stiffness * beta(0.4, 1.5) / beta(0.6, 1.5)
    return stability_limit(method, stiffness, conveyor.damping, conveyor.mass)


def outcome_of_impact(method: str, step: float, speed: float, conveyor: Conveyor) -> str:
    """Outcome of one Hertz impact, compared with the event-driven solver."""
    outcome, truth = restitution(method, step, speed, conveyor), restitution("event", math.nan, speed, conveyor, TRUTH)
    if not math.isfinite(outcome):
        return BLOWS_UP
    if outcome > 1.0:
        return GROWS
    return RIGHT if abs(outcome - truth) < RESTITUTION else WRONG


def outcome_on_conveyor(run: Columns, conveyor: Conveyor, duration: float) -> str:
    """Outcome for a part on the vibrating plate by a fixed-step method, compared with the event-driven solver.

    The energy grows if the largest gap is more than twice the true one.
    """
    truth = simulate(conveyor, Start(HEIGHT), duration=duration)
    velocity = truth.mean_velocity()
    if run.status != "ok" or max(abs(run.z_end), run.max_gap) > FAR:
        return BLOWS_UP
    if run.max_gap > 2.0 * truth.max_gap:
        return GROWS
    return RIGHT if abs(run.mean_velocity - velocity) < VELOCITY * abs(velocity) else WRONG


def penetration_on_conveyor(conveyor: Conveyor) -> float:
    """Largest penetration (m) in the last quarter of a run, from the largest contact force."""
    run = simulate(conveyor, Start(HEIGHT), duration=DURATION)
    force = run.sample(np.linspace(0.75, 1.0, 5001) * DURATION)["contact_force"].max()
    return (force / conveyor.stiffness) ** (1.0 / conveyor.exponent)


# The outcome as a function of the step (s), and the theoretical stability limit (s).
Experiment = tuple[Callable[[float], str], float]


def conveyor_experiments(method: str, values: np.ndarray) -> list[Experiment]:
    """Experiments on the vibrating plate; for each step, parts at all amplitudes are simulated side by side."""
    parameters = parameter_table(Conveyor(), Start(HEIGHT), acceleration=values)
    runs = cache(lambda step: sweep(parameters, duration=whole_steps(DURATION, step), method=method, step=step))

    def experiment(place: int) -> Experiment:
        conveyor = Conveyor(acceleration=values[place])
        stiffness = 1.5 * conveyor.stiffness * math.sqrt(penetration_on_conveyor(conveyor))

        def outcome(step: float) -> str:
            return outcome_on_conveyor(runs(step).select(place), conveyor, whole_steps(DURATION, step))

        return outcome, stability_limit(method, stiffness, conveyor.damping, conveyor.mass)

    return [experiment(place) for place in range(len(values))]


def rest_experiment(panel: str, method: str, value: float) -> Experiment:
    """The experiment with one value of a panel's quantity on a plate at rest."""
    mass = Conveyor().mass
    if panel in ("stiffness", "damping"):
        stiffness, damping = (CONTACT | {panel: value}).values()
        theory = stability_limit(method, stiffness, damping, mass)
        return lambda step: outcome_at_rest(method, step, stiffness, damping), theory
    conveyor = Conveyor(acceleration=0.0, gravity=1e-3, damping=CONTACT["damping"])
    theory = impact_limit(method, conveyor, value)
    return lambda step: outcome_of_impact(method, step, value, conveyor), theory


def panel_values(panel: str, effort: float) -> np.ndarray:
    """The values of the varied quantity of a panel."""
    spacing, smallest, largest, count = PANELS[panel]
    return spacing(smallest, largest, max(2, round(effort * count)))


def region_rows(effort: float, progress: str | None) -> list[dict]:
    """Outcomes over the step and one other quantity."""
    smallest, largest, count = STEPS
    steps = np.geomspace(smallest, largest, max(2, round(effort * count)))
    lines = []
    for panel in PANELS:
        values = panel_values(panel, effort)
        for method in FIXED_STEP_METHODS:
            if panel == "conveyor":
                experiments = conveyor_experiments(method, values)
            else:
                experiments = [rest_experiment(panel, method, value) for value in values]
            lines += [(panel, method, value, *pair) for value, pair in zip(values, experiments, strict=True)]
    rows = []
    for panel, method, value, outcome, theory in progress_bar(lines, label=progress, unit="lines"):
        rows += [row(panel, method, step, value, outcome(step), theory) for step in steps]
    return rows


def outcome_of_solver(panel: str, value: float) -> str:
    """Outcome of the solver at its default tolerance, with the criteria for methods with a step."""
    if panel != "conveyor":
        outcome, _ = rest_experiment(panel, "event", value)
        return outcome(math.nan)
    conveyor = Conveyor(acceleration=value)
    run, truth = (
        simulate(conveyor, Start(HEIGHT), duration=DURATION, tolerance=tolerance)
        for tolerance in (DEFAULT_TOLERANCE, TRUTH)
    )
    error = abs(run.mean_velocity() - truth.mean_velocity())
    return RIGHT if run.status == "ok" and error < VELOCITY * abs(truth.mean_velocity()) else WRONG


def row(panel: str, method: str, x: float, y: float, outcome: str, theory: float = math.nan) -> dict:
    return {"panel": panel, "method": method, "x": x, "y": y, "outcome": outcome, "theory": theory}


def make(settings: dict, *, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table of stability."""
    rows = region_rows(settings["effort"], progress)
    for panel in PANELS:
        for value in panel_values(panel, settings["effort"]):
            rows.append(row(panel, "event", math.nan, value, outcome_of_solver(panel, value)))
    return fields.columns(rows, TABLES["stability"])
