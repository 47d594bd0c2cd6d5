"""Rule stability: where methods stop working, over step and stiffness, damping or impact velocity; other failures."""

import math

import numpy as np
from scipy.optimize import brentq
from tqdm import tqdm

from conveyor import fixed_step, lyapunov, tables
from conveyor.model import PSI0, Conveyor, Start, pack
from conveyor.simulation import simulate
from rule_log import logged

RIGHT, WRONG, GROWS, BLOWS_UP = "right", "wrong state", "energy grows", "blow-up"
FAR = 1.0  # m: a part that far away has blown up
# The part rests in a Hooke contact and is pressed in by this share of its static penetration.
PRESSED = 0.5
# A contact that decays by this many e-foldings is at rest.
FOLDINGS = 8.0


def characteristic(stiffness: float, damping: float, mass: float) -> tuple[complex, complex]:
    """Both roots of λ² + (d/m) λ + k/m, 1/s."""
    root = np.sqrt(complex(0.25 * (damping / mass) ** 2 - stiffness / mass))
    return -0.5 * damping / mass + root, -0.5 * damping / mass - root


def limit(method: str, stiffness: float, damping: float, mass: float) -> float:
    """Largest stable step (s) of a method in a linear contact: k N/m, d N s/m, m kg.

    Explicit Euler: |1 + hλ| = 1, which is h = d/k for an oscillation. Semi-implicit Euler: h² k/m + 2 h d/m = 4, near
    2/ω. RK4: |R(hλ)| = 1 for its stability polynomial R, near 2.78/ω.
    """
    roots = characteristic(stiffness, damping, mass)
    if method == "euler":
        return min(-2.0 * root.real / abs(root) ** 2 for root in roots)
    if method == "semi_implicit_euler":
        rate, square = damping / mass, stiffness / mass
        return (math.sqrt(rate * rate + 4.0 * square) - rate) / square

    def growth(step):
        return max(abs(1 + (x := step * root) * (1 + x / 2 * (1 + x / 3 * (1 + x / 4)))) for root in roots) - 1.0

    size = max(map(abs, roots))
    return brentq(growth, 1.0 / size, 4.0 / size)


def resting(stiffness: float, damping: float) -> tuple[Conveyor, float, float]:
    """A plate at rest with a Hooke contact, the static penetration (m) and the time (s) in which a motion decays."""
    conveyor = Conveyor(acceleration=0.0, exponent=1.0, stiffness=stiffness, damping=damping)
    slowest = max(root.real for root in characteristic(stiffness, damping, conveyor.mass))
    return conveyor, conveyor.mass * conveyor.gravity / stiffness, FOLDINGS / -slowest


def outcome_at_rest(method: str, step: float, stiffness: float, damping: float) -> str:
    """What becomes of a part that is pressed into a plate at rest and let go."""
    conveyor, depth, duration = resting(stiffness, damping)
    start = Start(-(1.0 + PRESSED) * depth)
    if method == "event":
        run = simulate(conveyor, start, duration=duration)
        z, vz, highest = run.z_end, run.vz_end, run.max_gap
    else:
        found = fixed_step.run(pack(conveyor, start), duration, step, method)
        z, vz, highest = found.z, found.vz, found.max_gap
    if not (math.isfinite(z) and math.isfinite(vz)) or max(abs(z), highest) > FAR:
        return BLOWS_UP
    square = stiffness / conveyor.mass
    energy = 0.5 * vz * vz + 0.5 * square * (min(z, 0.0) + depth) ** 2 + conveyor.gravity * max(z, 0.0)
    if energy > 0.5 * square * (PRESSED * depth) ** 2:
        return GROWS
    return RIGHT if abs(z + depth) < 0.1 * PRESSED * depth else WRONG


def restitution(method: str, step: float, speed: float, conveyor: Conveyor) -> float:
    """Speed after one impact on a plate at rest over that before; infinity for a part that blows up."""
    height = 1e-6
    duration = 4.0 * height / speed + 6.0 * impact_time(conveyor, speed)
    start = Start(height, -speed)
    if method == "event":
        run = simulate(conveyor, start, duration=duration)
        z, vz = run.z_end, run.vz_end
    else:
        found = fixed_step.run(pack(conveyor, start), duration, step, method)
        z, vz = found.z, found.vz
    if not (math.isfinite(z) and abs(z) < FAR):
        return math.inf
    return math.sqrt(max(vz * vz + 2.0 * conveyor.gravity * (z - height), 0.0)) / speed if z > 0.0 else 0.0


def deepest(conveyor: Conveyor, speed: float) -> float:
    """Penetration (m) of an undamped Hertz impact."""
    return (1.25 * conveyor.mass * speed * speed / conveyor.stiffness) ** 0.4


def impact_time(conveyor: Conveyor, speed: float) -> float:
    """Duration (s) of an undamped Hertz impact: 2.943 δ_max / v."""
    return 2.9432750658 * deepest(conveyor, speed) / speed


def outcome_of_impact(method: str, step: float, speed: float, damping: float) -> str:
    """What becomes of one Hertz impact, against the event-driven solver."""
    conveyor = Conveyor(acceleration=0.0, gravity=1e-3, damping=damping)
    found, truth = (restitution(name, step, speed, conveyor) for name in (method, "event"))
    if not math.isfinite(found):
        return BLOWS_UP
    if found > 1.0:
        return GROWS
    return RIGHT if abs(found - truth) < 0.05 else WRONG


def region_rows(settings: dict, progress: str | None) -> list[dict]:
    """Outcomes over the steps and one other quantity."""
    low, high, count = (settings["step"][name] for name in ("start", "stop", "num"))
    steps = np.geomspace(low, high, count)
    model = settings["contact"]
    rows = []
    for panel in ("stiffness", "damping", "impact velocity"):
        axis = settings[panel.replace(" ", "_")]
        values = np.geomspace(axis["start"], axis["stop"], axis["num"])
        methods = settings["methods"] if panel != "impact velocity" else settings["methods"][:1]
        for method in methods:
            for value in tqdm(values, desc=progress and f"{progress}: {panel}, {method}", disable=progress is None):
                for step in steps:
                    if panel == "stiffness":
                        outcome = outcome_at_rest(method, step, value, model["damping"])
                        theory = limit(method, value, model["damping"], Conveyor().mass)
                    elif panel == "damping":
                        outcome = outcome_at_rest(method, step, model["stiffness"], value)
                        theory = limit(method, model["stiffness"], value, Conveyor().mass)
                    else:
                        outcome = outcome_of_impact(method, step, value, model["damping"])
                        stiffness = 1.5 * Conveyor().stiffness * math.sqrt(deepest(Conveyor(), value))
                        theory = limit(method, stiffness, model["damping"], Conveyor().mass)
                    rows.append(row(panel, method, step, value, outcome, theory))
    return rows


def row(panel: str, method: str, x: float, y: float, outcome: str, theory: float = math.nan) -> dict:
    return {"panel": panel, "method": method, "x": x, "y": y, "outcome": outcome, "theory": theory}


def edge_rows(settings: dict) -> list[dict]:
    """Measured edges of the right state in a linear contact, by bisection to a hundredth, and theory."""
    axis = settings["stiffness"]
    rows = []
    for method in settings["methods"]:
        for value in np.geomspace(axis["start"], axis["stop"], axis["num"])[::2]:
            theory = limit(method, value, settings["contact"]["damping"], Conveyor().mass)
            low, high = 0.3 * theory, 3.0 * theory
            while high > 1.01 * low:
                middle = math.sqrt(low * high)
                stable = outcome_at_rest(method, middle, value, settings["contact"]["damping"])
                low, high = (middle, high) if stable in (RIGHT, WRONG) else (low, middle)
            rows.append(row("edge", method, low, value, RIGHT, theory))
    return rows


def chatter_rows(settings: dict) -> list[dict]:
    """Root mean square slip velocity (m/s) of Euler while the part should stick, over the step (s)."""
    conveyor = Conveyor(**settings["stick"])
    rows = []
    for step in settings["chatter_steps"]:
        times = 0.1 + step * np.arange(2000)
        for method in ("euler", "event"):
            run = simulate(conveyor, Start("conveyor"), duration=times[-1], method=method, step=step)
            found = run.sample(times)
            omega = 2.0 * math.pi * conveyor.frequency
            plate = conveyor.acceleration * math.cos(conveyor.angle) / omega * np.sin(omega * times)
            slip = float(np.sqrt(np.mean((found["vx"] - plate) ** 2)))
            rows.append(row("chatter", method, step, slip, RIGHT if slip < 1e-12 else WRONG))
    return rows


def estimate_rows(settings: dict) -> list[dict]:
    """The published estimate of the exponent (1/s) over the perturbation (rad) in regular motion."""
    conveyor = Conveyor(acceleration=settings["acceleration"])
    rows = []
    for method in ("euler", "event"):
        for epsilon in settings["epsilons"]:
            here = pack(conveyor, Start("conveyor"))[None]
            there = here.copy()
            there[:, PSI0] += epsilon
            value = lyapunov.finite_difference_estimate(here, there, epsilon, output="vx", method=method)[0]
            rows.append(row("estimate", method, epsilon, float(value), RIGHT if value < 0.0 else WRONG))
    return rows


def hard_rows(settings: dict) -> list[dict]:
    """The event-driven solver in hard cases: relative change of the end at a hundredth of the tolerance."""
    rows = []
    for case in settings.values():
        model = dict(case["model"])
        start = Start(model.pop("z0", 0.0), model.pop("vz0", 0.0))
        loose, tight = (
            simulate(Conveyor(**model), start, duration=case["duration"], tolerance=tolerance)
            for tolerance in (1e-10, 1e-12)
        )
        change = abs(loose.z_end - tight.z_end) / max(abs(tight.z_end), 1e-9)
        fine = loose.status == tight.status == "ok" and change < 1e-6
        rows.append(row(f"hard: {case['label']}", "event", loose.event_count, change, RIGHT if fine else WRONG))
    return rows


def columns(settings: dict, *, progress: str | None = None) -> dict[str, np.ndarray]:
    """The columns of the table of stability."""
    rows = region_rows(settings, progress) + edge_rows(settings) + chatter_rows(settings)
    rows += estimate_rows(settings["estimate"]) + hard_rows(settings["hard"])
    return {name: np.array([one[name] for one in rows]) for name in rows[0]}


if __name__ == "__main__":
    with logged(snakemake.log[0]):
        settings = snakemake.params.settings
        tables.write(snakemake.output[0], "stability", columns(settings, progress="stability"), settings=settings)
