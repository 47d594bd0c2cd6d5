"""Fixed-step methods: closed forms, orders of convergence, limits of stability, the numbers of the paper's method."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from reference import reference_mean_velocity
from scipy.special import gamma

from conveyor import Conveyor, Start, ensemble, simulate
from conveyor.methods import fixed_step
from conveyor.methods.scheme import EVALUATIONS, IMPACT_SPEED, PEAK_FORCE
from conveyor.solver.model import VZ0, pack
from conveyor.solver.record import SAMPLES
from conveyor.solver.status import NOT_FINITE, OK

# A contact that stays closed (p = 1, a_z < g), smooth in time.
LINEAR = Conveyor(acceleration=30.0, exponent=1.0, stiffness=3e3, psi0=0.4)
TILTED = {"inclination": 0.2, "phase_shift": 0.7}


def run_one(parameters, *arguments):
    """The results of one trajectory."""
    columns = fixed_step.run(parameters[None], *arguments)
    return SimpleNamespace(**{name: column.item() for name, column in columns.items()})


def slow_integrate(parameters, step, n_steps, method):
    """Plain implementations of the methods from Eqs. 2-12: states and forces at all steps, shape (n_steps + 1, 6)."""
    a, phi, f, psi0, k_c, d_c, mu, m, p, g, alpha, shift, _, tension, z0, vz0 = map(float, parameters)
    omega = 2.0 * math.pi * f
    a_x, a_z = a * math.cos(phi), a * math.sin(phi)

    def forces(t, y):
        theta = omega * t + psi0
        gap = y[2] + a_z / omega**2 * math.cos(theta)
        if gap > 0.0:
            return 0.0, 0.0
        normal = k_c * (-gap) ** p - d_c * (y[3] - a_z / omega * math.sin(theta))
        if tension == 2 and normal < 0.0:
            normal = 0.0
        rubs = 0.0 if tension == 1 and normal < 0.0 else mu * normal
        return normal, rubs * float(np.sign(a_x / omega * math.sin(theta + shift) - y[1]))

    def rates(t, y):
        normal, friction = forces(t, y)
        return np.array([y[1], friction / m - g * math.sin(alpha), y[3], normal / m - g * math.cos(alpha)])

    y = np.array([0.0, 0.0, z0, vz0])
    rows = []
    for i in range(n_steps + 1):
        t = i * step
        rows.append([*y, *forces(t, y)])
        k1 = rates(t, y)
        if method == "euler":
            y = y + step * k1
        elif method == "semi_implicit_euler":
            y[[1, 3]] += step * k1[[1, 3]]
            y[[0, 2]] += step * y[[1, 3]]
        else:
            k2 = rates(t + step / 2, y + step / 2 * k1)
            k3 = rates(t + step / 2, y + step / 2 * k2)
            k4 = rates(t + step, y + step * k3)
            y = y + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return np.array(rows)


@pytest.mark.parametrize("method", fixed_step.METHODS)
@pytest.mark.parametrize(
    ("tension", "exponent", "track"),
    [
        ("allow", 1.5, {}),
        ("allow", 1.8, TILTED),
        ("frictionless", 1.0, {}),
        ("frictionless", 1.5, TILTED),
        ("clip", 1.8, {}),
        ("clip", 1.0, TILTED),
    ],
)
def test_compiled_loop_agrees_with_the_plain_loop(method, tension, exponent, track):
    """Over two impacts the compiled loop differs from the plain loop only by rounding."""
    stiffness = {1.0: 3e3, 1.5: 5e5, 1.8: 5e6}[exponent]
    conveyor = Conveyor(tension=tension, exponent=exponent, stiffness=stiffness, **track)
    parameters = pack(conveyor, Start(z=5e-5, vz=-0.05))
    step, n_steps = 2e-5, 1500
    slow = slow_integrate(parameters, step, n_steps, method)
    fast = fixed_step.sample(parameters, step * np.arange(n_steps + 1), step, method)
    for k, name in enumerate(SAMPLES):
        np.testing.assert_allclose(fast[name], slow[:, k], rtol=1e-10, atol=1e-11 * np.abs(slow[:, k]).max())

    theta = 100.0 * math.pi * step * np.arange(n_steps)
    gap = slow[:-1, 2] + 40.0 * math.sin(math.radians(12.0)) / (100.0 * math.pi) ** 2 * np.cos(theta)
    changes = np.diff((gap <= 0.0).astype(int))
    events = fixed_step.events(parameters, n_steps * step, step, method)
    assert {"impact", "separation"} <= set(events["kind"])
    np.testing.assert_array_equal(events["time"], step * (np.flatnonzero(changes) + 1))
    np.testing.assert_array_equal(events["kind"] == "impact", changes[changes != 0] == 1)
    run = run_one(parameters, n_steps * step, step, method)
    assert run.impacts == np.count_nonzero(changes == 1)
    assert run.contact_fraction == pytest.approx(np.count_nonzero(slow[:-1, 4]) / n_steps, rel=1e-14)
    assert run.max_gap == pytest.approx(gap.max(), rel=1e-10)
    assert run.mean_velocity == pytest.approx((slow[-1, 0] - slow[1125, 0]) / (375 * step), rel=1e-9)
    assert run.work == n_steps * EVALUATIONS[fixed_step.METHODS.index(method)]


def test_a_run_may_have_any_number_of_events(monkeypatch):
    parameters = pack(Conveyor(), Start(z=3e-4))
    wanted = fixed_step.events(parameters, 0.2, 1e-5)
    assert len(wanted) > 10
    monkeypatch.setattr(fixed_step, "LIKELY_EVENTS", 3)
    np.testing.assert_array_equal(fixed_step.events(parameters, 0.2, 1e-5), wanted)


def test_the_paper_s_numbers():
    """Mean feeding velocities of the paper's method at its step of 5e-7 s."""
    for acceleration, z, expected in ((30.0, 0.0, 0.00709042), (40.0, 3e-4, 0.0646877)):
        run = run_one(pack(Conveyor(acceleration=acceleration), Start(z=z)), 1.0, 5e-7)
        assert run.mean_velocity == pytest.approx(expected, rel=2e-6)
        assert run.status == OK


@pytest.mark.parametrize(("method", "share"), [("euler", 0.5), ("semi_implicit_euler", -0.5), ("rk4", 0.0)])
def test_free_fall(method, share):
    """The height errs by exactly ±gTΔt/2 for the Euler methods and not at all for RK4."""
    step, n_steps = 1e-4, 777
    run = run_one(pack(Conveyor(), Start(z=0.1, vz=0.2)), n_steps * step, step, method)
    time = n_steps * step
    exact = 0.1 + 0.2 * time - 0.5 * 9.81 * time**2
    assert run.z_end - exact == pytest.approx(share * 9.81 * time * step, abs=1e-15)
    assert run.vz_end == pytest.approx(0.2 - 9.81 * time, rel=1e-13)
    assert (run.x_end, run.vx_end, run.impacts, run.contact_fraction) == (0.0, 0.0, 0, 0.0)


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.5])
def test_undamped_impact(exponent):
    """Penetration, duration and restitution of an impact on a plate at rest; Euler gains speed in proportion to Δt."""
    speed = 0.5
    conveyor = Conveyor(acceleration=0.0, damping=0.0, exponent=exponent, gravity=1e-3)
    parameters = pack(conveyor, Start(z="conveyor", vz=-speed))
    share = 1.0 / (exponent + 1.0)
    depth = (conveyor.mass * speed**2 / (2.0 * share * conveyor.stiffness)) ** share
    lasting = 2.0 * depth / speed * math.sqrt(math.pi) * gamma(1.0 + share) / gamma(0.5 + share)
    step = lasting / 2000.0

    samples = fixed_step.sample(parameters, step * np.arange(2100), step, "rk4")
    assert samples["z"].min() == pytest.approx(-depth, rel=1e-5)
    (separation,) = fixed_step.events(parameters, 1.05 * lasting, step, "rk4")
    assert separation["kind"] == "separation"
    assert abs(separation["time"] - lasting) <= 1.001 * step

    gains = {
        (method, n): run_one(parameters, 1.05 * lasting, lasting / n, method).vz_end / speed - 1.0
        for method in fixed_step.METHODS
        for n in (2000, 4000)
    }
    assert 1.9 < gains["euler", 2000] / gains["euler", 4000] < 2.1
    assert gains["euler", 4000] > 1e-4
    assert abs(gains["semi_implicit_euler", 4000]) < 0.02 * gains["euler", 4000]
    assert abs(gains["rk4", 4000]) < 2e-6


@pytest.mark.parametrize(("method", "order"), [("euler", 1), ("semi_implicit_euler", 1), ("rk4", 4)])
def test_order_in_smooth_contact(method, order):
    """Halving the step divides the error in a forced, damped, linear contact by 2^order."""
    a_z, omega = LINEAR.acceleration * math.sin(LINEAR.angle), 2.0 * math.pi * LINEAR.frequency
    kappa, decay, duration = LINEAR.stiffness / LINEAR.mass, LINEAR.damping / LINEAR.mass, 0.01
    plate_z, plate_vz = -a_z / omega**2 * math.cos(LINEAR.psi0), a_z / omega * math.sin(LINEAR.psi0)
    parameters = pack(LINEAR, Start(z=plate_z - LINEAR.gravity / kappa, vz=plate_vz))
    # Closed form from q = -mg/k, q̇ = 0: forced response and free oscillation.
    forced = -a_z / (kappa - omega**2 + 1j * omega * decay) * np.exp(1j * LINEAR.psi0)
    root = complex(-0.5 * decay, math.sqrt(kappa - 0.25 * decay**2))
    value, rate = -forced.real, (omega * forced).imag
    free = complex(value, (root.real * value - rate) / root.imag)
    q = -LINEAR.gravity / kappa + (forced * np.exp(1j * omega * duration) + free * np.exp(root * duration)).real
    exact = q - a_z / omega**2 * math.cos(omega * duration + LINEAR.psi0)

    errors = []
    coarse = 400 if order == 4 else 6400
    for n in (coarse, 2 * coarse):
        run = run_one(parameters, duration, duration / n, method)
        assert run.contact_fraction == 1.0
        errors.append(abs(run.z_end - exact))
    assert math.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.15)


@pytest.mark.parametrize("method", fixed_step.METHODS)
def test_friction_follows_the_vertical_motion(method):
    """While the slip keeps its sign, ẋ = μ (ż - ż_0 + g t) holds at every step, not only in the limit."""
    conveyor = Conveyor(acceleration=30.0, friction=0.01, psi0=0.5)
    start = Start(z="conveyor", vz=30.0 * math.sin(math.radians(12.0)) / (100.0 * math.pi) * math.sin(0.5))
    times = 1e-5 * np.arange(800)
    samples = fixed_step.sample(pack(conveyor, start), times, 1e-5, method)
    np.testing.assert_allclose(samples["vx"], 0.01 * (samples["vz"] - start.vz + 9.81 * times), rtol=0.0, atol=1e-14)
    assert samples["vx"][-1] > 5e-4


def test_sign_of_zero_slip():
    """At the beginning, part and plate have no horizontal velocity, so there is a contact force but no friction."""
    samples = fixed_step.sample(pack(Conveyor(), Start(z=-1e-3)), np.array([0.0]), 1e-6)
    assert samples["contact_force"][0] > 0.0
    assert samples["friction_force"][0] == 0.0


def test_a_gap_of_zero_is_contact():
    """A part that starts on the conveyor with a downward speed is braked by the damper at once."""
    samples = fixed_step.sample(pack(Conveyor(), Start(z="conveyor", vz=-0.2)), np.array([0.0]), 1e-6)
    assert samples["contact_force"][0] == pytest.approx(0.3 * 0.2, rel=1e-14)


def test_tension():
    """Damping pulls before separation: with friction, without, or not at all."""
    samples = {
        tension: fixed_step.sample(pack(Conveyor(tension=tension), Start(z=3e-4)), np.arange(0.0, 0.2, 1e-5), 1e-6)
        for tension in ("allow", "frictionless", "clip")
    }
    for tension, found in samples.items():
        pulled = found["contact_force"] < 0.0
        assert pulled.any() == (tension != "clip")
        assert found["friction_force"][pulled].any() == (tension == "allow")
        bound = Conveyor().friction * np.abs(found["contact_force"])
        assert (np.abs(found["friction_force"]) <= bound * (1.0 + 1e-12)).all()


def test_sampling_does_not_disturb_the_run():
    parameters = pack(Conveyor(acceleration=80.0), Start())
    n_steps, step = 20_000, 2e-6
    indices = np.sort(np.append(np.arange(0, n_steps + 1, 100), [1, 1, 255, 256, 257]))
    for method in fixed_step.METHODS:
        (watched,), (samples,), (events,) = fixed_step.follow(parameters[None], step, n_steps, method, indices, 4)
        (alone,), _, (same_events,) = fixed_step.follow(parameters[None], step, n_steps, method, [], 4)
        # Peaks count since the last sample.
        assert watched[:-2].tolist() == alone[:-2].tolist()
        assert events[1, 0] > 0.0
        np.testing.assert_array_equal(events, same_events)
        assert samples[-1, :4].tolist() == watched[:4].tolist()
        np.testing.assert_array_equal(samples[1], samples[2])  # one step, requested twice


@pytest.mark.parametrize("method", fixed_step.METHODS)
def test_many_are_followed_as_one_is(method):
    """Sweeps give what single runs give, to the last bit, however they are shared out."""
    step, duration = 1e-5, 0.05
    parameters = np.array(
        [pack(Conveyor(acceleration=20.0 + 5.0 * k, exponent=(1.5, 1.8)[k % 2]), Start(z=1e-5 * k)) for k in range(11)]
    )
    runs = [run_one(row, duration, step, method) for row in parameters]
    for sharing in ({"chunk": 11}, {"chunk": 1}, {"chunk": 3, "threads": 2}):
        rows = ensemble.sweep(parameters, duration=duration, method=method, step=step, **sharing)
        assert set(rows.status) == {"ok"}
        for name in set(rows) - {"status"}:
            assert rows[name].tolist() == [getattr(run, name) for run in runs]


def test_samples_keep_the_order_and_shape_of_the_times():
    parameters = pack(Conveyor(), Start(z=3e-4))
    times = np.array([[0.02, 0.0], [0.01, 0.02]])
    samples = fixed_step.sample(parameters, times, 1e-5)
    for i, j in np.ndindex(times.shape):
        alone = fixed_step.sample(parameters, times[i, j], 1e-5)
        for name in SAMPLES:
            assert samples[name][i, j] == alone[name]


def contact_oscillation(step, omega, damping_ratio, steps):
    """Growth of a small contact oscillation about static equilibrium on a plate at rest, over a number of steps."""
    mass = 0.7e-3
    conveyor = Conveyor(
        acceleration=0.0, exponent=1.0, mass=mass, stiffness=mass * omega**2, damping=2.0 * damping_ratio * omega * mass
    )
    rest = -conveyor.gravity / omega**2
    amplitude = 1e-3 * abs(rest)
    run = run_one(pack(conveyor, Start(z=rest + amplitude)), steps * step, step, "euler")
    return math.hypot(run.z_end - rest, run.vz_end / omega) / amplitude


@pytest.mark.parametrize("damping_ratio", [0.01, 0.05, 0.13])
def test_explicit_euler_amplifies_above_damping_over_stiffness(damping_ratio):
    """Each step multiplies the oscillation by √(1 - Δt d/m + Δt² k/m): growth unless Δt < d_c/k."""
    omega = 1600.0
    limit = 2.0 * damping_ratio / omega
    for share in (0.5, 0.95, 1.05, 2.0):
        step = share * limit
        excess = (omega * step) ** 2 - 2.0 * damping_ratio * omega * step
        assert (excess > 0.0) == (share > 1.0)
        steps = round(6.0 / abs(excess))
        growth = contact_oscillation(step, omega, damping_ratio, steps)
        # The tolerance is wide, because the oscillation is an ellipse that is sampled at one phase.
        assert growth == pytest.approx((1.0 + excess) ** (0.5 * steps), rel=0.3)


@pytest.mark.parametrize("method", fixed_step.METHODS)
def test_converges_to_the_reference(method):
    """Over impacts and friction reversals, every method converges to the slow reference with first order."""
    conveyor, start, duration = Conveyor(), Start(z=3e-4), 0.1
    exact = reference_mean_velocity(conveyor, start, duration)
    errors = [
        abs(run_one(pack(conveyor, start), duration, step, method).mean_velocity / exact - 1.0)
        for step in (1.6e-6, 1e-7, 1e-8)
    ]
    assert errors[2] < errors[1] < errors[0] < 0.1
    assert errors[2] < 5e-4


def test_status_not_finite():
    """The height of a part that is too fast overflows: the status says so, and samples after that point are NaN."""
    parameters = pack(Conveyor(), Start(z=3e-4))
    parameters[VZ0] = 1e307
    run = run_one(parameters, 1e3, 10.0)
    assert run.status == NOT_FINITE
    samples = fixed_step.sample(parameters, np.array([0.0, 1e4]), 10.0)
    assert samples["z"][0] == 3e-4
    assert np.isnan(samples["z"][1])


def test_a_run_lasts_for_its_duration():
    """Steps that do not divide the duration would end early."""
    with pytest.raises(ValueError, match=r"no whole number of steps of 3e-07 s; take step = 3.00000030"):
        simulate(Conveyor(), duration=1.0, method="euler", step=3e-7)
    with pytest.raises(ValueError, match="whole number"):
        ensemble.sweep(pack(Conveyor(), Start())[None], duration=1e-3, method="euler", step=5e-3)
    assert simulate(Conveyor(), duration=0.3, method="euler", step=1e-5).status == "ok"  # 0.3 / 1e-5 rounds


@pytest.mark.parametrize("method", fixed_step.METHODS)
def test_a_part_that_slips_at_the_start_does_not_stick_at_once(method):
    """It rests while the plate moves, and gets the plate's velocity only after its slip has vanished."""
    conveyor = Conveyor(psi0=0.5, friction=0.1, static_friction=10.0)
    first = fixed_step.sample(pack(conveyor, Start(z="conveyor")), np.array([0.0]), 1e-6, method)
    assert first["contact_force"][0] > 0.0
    assert first["vx"][0] == 0.0


@pytest.mark.parametrize("method", fixed_step.METHODS)
def test_peaks_cover_the_last_part_of_a_run(method):
    """A part that falls onto the plate hits it hard at first only."""
    parameters = pack(Conveyor(acceleration=5.0), Start(1e-3))
    late = run_one(parameters, 0.5, 2e-6, method)
    (whole,), _, _ = fixed_step.follow(parameters[None], 2e-6, 250_000, method)  # no sample ends the count of peaks
    assert whole[IMPACT_SPEED] > 0.1 > 10.0 * late.impact_speed
    assert whole[PEAK_FORCE] > 10.0 * late.peak_force > 0.0


def test_each_trajectory_is_sampled_at_its_own_times():
    """Those with equal times are followed together."""
    starts, times = [Start(1e-4), Start(2e-4), Start(3e-4)], np.array([[0.0, 0.01], [0.005, 0.01], [0.0, 0.01]])
    table = np.array([pack(Conveyor(), start) for start in starts])
    found = ensemble.sample_runs(table, times, columns=["z", "vx"], method="euler", step=1e-6, chunk=10**6)
    for k, start in enumerate(starts):
        alone = simulate(Conveyor(), start, duration=0.01, method="euler", step=1e-6).sample(times[k])
        assert found.z[k].tolist() == alone["z"].tolist()
        assert found.vx[k].tolist() == alone["vx"].tolist()
