"""Fixed-step integration of the model: explicit Euler as the paper publishes it, semi-implicit Euler, classical RK4.

The event-driven solver is compared with these methods. They step over impacts and separations. Friction has the sign of
ẋ_s - ẋ_p, with sign(0) = 0, so that they chatter where the part should stick. In contact (q ≤ 0) the force may be
negative, as in Eqs. 7 and 11, unless the model's `tension` excludes it. The published scheme has no stick. Therefore,
where static_friction exceeds friction, a part whose slip has vanished or changed its sign since the last step gets the
plate's velocity while |ẍ_s + g sin α| ≤ μ_s F_c/m.

Time is the step number times the step and does not drift. For the exponents 1 and 1.5 no library function is called, so
that every machine gives the same digits. `scheme` has the steps, `fixed_step_lanes` the loops over them,
`recording` what they leave behind.
"""

import math

import numpy as np

from ..arguments import check_choice
from ..packing import as_rows
from ..parallel import call_interruptibly
from ..parameters import FIXED_STEP_METHODS as METHODS
from ..parameters import LAST
from ..solver.contact_lanes import new_memory
from ..solver.record import SAMPLES, name_events
from ..solver.status import OK
from . import scheme
from .fixed_step_lanes import FIRST_WAVE, compiled_for, kind_of

# The factor of a step h on a decay exp(λt), as coefficients of the powers of hλ; None for a step without such a factor.
GROWTH = {"euler": (1.0, 1.0), "semi_implicit_euler": None, "rk4": (1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0)}
LIKELY_EVENTS = 1000  # of a run; a run with more events is repeated, with room for all of them
LONG = 10**6  # steps of all runs, which take some hundredths of a second
WHOLE = 1e-9  # relative distance from a whole number of steps that counts as rounding of duration and step


def step_count(duration: float, step: float) -> int:
    """The number of steps (s) in `duration` (s), both above 0; ValueError if it is not whole."""
    count = round(duration / step)
    if abs(duration / step - count) > WHOLE * max(count, 1) or count == 0:
        nearest = max(count, 1)
        raise ValueError(
            f"duration = {duration!r} s is no whole number of steps of {step!r} s; "
            f"take step = {duration / nearest!r} or duration = {nearest * step!r}"
        )
    return count


def follow(parameters, step, n_steps, method, indices=(), n_events=0):
    """Follow n trajectories, shape (n, 16), from t = 0 over `n_steps` steps (s) by one of METHODS.

    Parameters
    ----------
    indices : ascending step numbers in [0, n_steps] to be sampled, shape (k,)
    n_events : number m of events of each trajectory that are wanted

    Returns
    -------
    results : float64, shape (n, RESULTS): x (m), vx (m/s), z (m), vz (m/s) at the last step; number of events; impacts;
        time with contact force (s); largest gap (m) at the steps; number of force evaluations; status; largest speed of
        approach at an impact (m/s) and largest contact force (N) since the last sample
    samples : float64, shape (n, k, 6), x, vx, z, vz (m, m/s), contact and friction force (N); NaN behind the check that
        finds a state not finite
    events : float64, shape (n, m, 2), time (s) and kind of the first m events, or NaN; an event has the time of the
        first step at which the other side of q = 0 is seen
    """
    check_choice("method", method, METHODS)
    parameters, indices = as_rows(parameters), np.asarray(indices, dtype=np.int64)
    n = len(parameters)
    samples, results = np.full((n, len(indices), len(SAMPLES)), math.nan), np.empty((n, scheme.RESULTS))
    events = np.full((n, n_events, 2), math.nan)
    integrate = compiled_for(kind_of(METHODS.index(method), parameters))
    memory = new_memory(scheme.WAVES + parameters.shape[1] - FIRST_WAVE)
    stopped = np.zeros(1, dtype=np.bool_)

    def run_all():
        integrate(parameters, float(step), n_steps, indices, samples, events, results, stopped, memory)

    call_interruptibly(run_all, lambda: stopped.fill(True), is_long=n * n_steps > LONG)
    return results, samples, events


def run(parameters: np.ndarray, duration: float, step: float, method: str = "euler") -> dict[str, np.ndarray]:
    """Integrate n trajectories from t = 0; together they take less time than one by one, with the same bits.

    Parameters
    ----------
    parameters : float64, shape (n, 16), rows from `model.pack`
    duration : s; ValueError unless it is a whole number of steps
    step : Δt, s
    method : one of METHODS

    Returns
    -------
    the mean velocity (m/s) and what simulation.name_results returns, shape (n,); work is the number of evaluations of
    the forces, and events are not counted, because a Run follows them again
    """
    n_steps = step_count(duration, step)
    first = min(round((1.0 - LAST) * n_steps), n_steps - 1)
    results, samples, _ = follow(parameters, step, n_steps, method, [first])
    failed, nothing = results[:, scheme.STATUS] != OK, np.zeros(len(parameters))
    velocity = (results[:, scheme.X] - samples[:, 0, scheme.X]) / ((n_steps - first) * step)
    return {
        "mean_velocity": velocity,
        "x_last": results[:, scheme.X] - velocity * LAST * duration,
        "x_end": results[:, scheme.X],
        "vx_end": results[:, scheme.VX],
        "z_end": results[:, scheme.Z],
        "vz_end": results[:, scheme.VZ],
        "max_gap": results[:, scheme.MAX_GAP],
        "impacts": results[:, scheme.IMPACTS],
        "contact_fraction": results[:, scheme.CONTACT_TIME] / (n_steps * step),
        "impact_speed": np.where(failed, math.nan, results[:, scheme.IMPACT_SPEED]),
        "peak_force": np.where(failed, math.nan, results[:, scheme.PEAK_FORCE]),
        "status": results[:, scheme.STATUS],
        "work": results[:, scheme.FORCE_EVALUATIONS],
        "repeats": nothing,
        "event_count": nothing,
    }


def sample(parameters: np.ndarray, times: np.ndarray, step: float, method: str = "euler") -> dict[str, np.ndarray]:
    """States and forces of trajectories at the steps nearest to `times` (s, not negative, any shape s and order).

    Returns x, z (m), vx, vz (m/s), contact_force, friction_force (N), float64, shape (*m, *s) for parameters of the
    shape (*m, 16); NaN after a state that is not finite. The other parameters are as in `run`.
    """
    indices, place = np.unique(np.rint(times / step).astype(np.int64), return_inverse=True)
    rows, shape = parameters.reshape(-1, parameters.shape[-1]), (*parameters.shape[:-1], *times.shape)
    _, samples, _ = follow(rows, step, int(indices.max(initial=1)), method, indices)
    return {name: samples[:, place.ravel(), k].reshape(shape) for k, name in enumerate(SAMPLES)}


def events(parameters: np.ndarray, duration: float, step: float, method: str = "euler") -> np.ndarray:
    """Impacts and separations of one trajectory, as the fixed steps see them.

    Parameters as in `run`. The array has the fields time (s) and kind ("impact", "separation"), in order of time.
    """
    n_steps = step_count(duration, step)
    (results,), _, (rows,) = follow(parameters[np.newaxis], step, n_steps, method, n_events=LIKELY_EVENTS)
    n_events = int(results[scheme.EVENTS])
    if n_events > LIKELY_EVENTS:
        _, _, (rows,) = follow(parameters[np.newaxis], step, n_steps, method, n_events=n_events)
    return name_events(rows[:n_events, 0], rows[:n_events, 1].astype(np.int64))
