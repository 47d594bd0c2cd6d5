"""Random parameters: no hang, no NaN, no fall through the plate, and reproducible results."""

import math
from dataclasses import replace
from pathlib import Path
from time import process_time

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, example, given, settings
from hypothesis import strategies as st
from random_conveyors import around_the_paper, deepest_allowed, tilted, whole_ranges

from conveyor import Conveyor, Start, ensemble, plate_motion, simulate
from conveyor.parameters import RANGES, TENSION_MODES
from conveyor.solver.model import FREQUENCY, pack, unpack

# A failing example is printed as it is found: shrinking runs that end with `contact too stiff` would take minutes.
NO_SHRINKING = (Phase.explicit, Phase.reuse, Phase.generate)


def logarithmic(low, high):
    """Log-uniform from the larger of `low` and a millionth of `high`; also zero if `low` is zero."""
    size = st.floats(math.log(max(low, 1e-6 * high)), math.log(high)).map(lambda x: min(max(math.exp(x), low), high))
    return st.one_of(st.just(0.0), size) if low == 0.0 else size


def signed(low, high):
    """The same with either sign."""
    return st.builds(
        lambda sign, size: min(max(sign * size, low), high), st.sampled_from([-1.0, 1.0]), logarithmic(0.0, high)
    )


RATIOS = ("acceleration", "frequency", "stiffness", "damping", "friction", "mass", "gravity")


def tilt(conveyor, inclination, phase_shift, ratio):
    """The same conveyor on an inclined track with an elliptical drive and a static friction."""
    static = min(ratio * conveyor.friction, RANGES["static_friction"][1])
    return replace(conveyor, inclination=inclination, phase_shift=phase_shift, static_friction=static)


TRACK = (st.floats(*RANGES["inclination"]), st.floats(*RANGES["phase_shift"]), st.floats(1.0, 3.0))
anywhere = st.builds(
    Conveyor,
    **{name: logarithmic(*RANGES[name]) for name in RATIOS},
    angle=st.floats(*RANGES["angle"]),
    psi0=st.floats(*RANGES["psi0"]),
    exponent=st.one_of(st.sampled_from([1.0, 1.5, 2.0, 3.0]), st.floats(*RANGES["exponent"])),
    tension=st.sampled_from(TENSION_MODES),
)
starts_anywhere = st.builds(Start, z=st.one_of(st.just("conveyor"), signed(*RANGES["z0"])), vz=signed(*RANGES["vz0"]))


def around(default):
    """Two decades around a default, log-uniform."""
    return st.floats(-1.0, 1.0).map(lambda exponent: default * 10.0**exponent)


# For runs that do not end early.
conveyors = st.builds(
    Conveyor,
    acceleration=st.floats(0.0, 150.0),
    angle=st.floats(0.0, 0.5 * math.pi),
    frequency=st.floats(math.log(5.0), math.log(500.0)).map(math.exp),
    psi0=st.floats(0.0, 2.0 * math.pi),
    stiffness=around(5e5),
    damping=st.one_of(st.just(0.0), around(0.3)),
    friction=around(0.15),
    mass=around(0.7e-3),
    exponent=st.one_of(st.sampled_from([1.0, 1.5, 2.0, 3.0]), st.floats(1.0, 3.0)),
    tension=st.sampled_from(TENSION_MODES),
)
starts = st.builds(Start, z=st.one_of(st.just("conveyor"), st.floats(-1e-4, 1e-2)), vz=st.floats(-1.0, 1.0))


def check(run, tolerance):
    """The motion of a run is finite, above the plate, within the cone of friction, and its events are in order."""
    times = np.linspace(0.0, run.duration, 101)
    sample = run.sample(times)
    assert all(np.isfinite(values).all() for values in sample.values())
    depth = plate_motion(run.conveyor, times)["z"] - sample["z"]
    allowed = deepest_allowed(pack(run.conveyor, run.start)[None], np.array([run.max_gap]))[0]
    assert depth.max() <= allowed * (1.0 + 1e-6) + 1e-12 * abs(sample["z"]).max()
    # It is a sum over steps with rounding errors.
    assert 0.0 <= run.contact_fraction <= 1.0
    assert (np.diff(run.events["time"]) >= -1e-12 * run.duration).all()  # of one moment, up to rounding
    static = max(run.conveyor.friction, run.conveyor.static_friction or 0.0)
    force = static * np.abs(sample["contact_force"])
    # A force below the resolution of stick also causes friction.
    least = 100.0 * tolerance * run.conveyor.mass * run.conveyor.gravity * (1.0 + static)
    assert (np.abs(sample["friction_force"]) <= force * (1.0 + 1e-6) + least).all()


@settings(max_examples=200, deadline=None, phases=NO_SHRINKING, suppress_health_check=[HealthCheck.too_slow])
@given(st.one_of(anywhere, st.builds(tilt, anywhere, *TRACK)), starts_anywhere)
def test_any_run_within_the_ranges_ends_with_a_motion_or_a_reason(conveyor, start):
    simulate(Conveyor(), duration=0.02)  # compiled before the time is measured
    begin = process_time()
    run = simulate(conveyor, start, duration=3.0 / conveyor.frequency, tolerance=1e-9)
    assert process_time() - begin < 10.0
    rate = max(
        conveyor.damping / conveyor.mass,
        math.sqrt(2.0 * conveyor.gravity)
        * (conveyor.gravity * conveyor.mass / conveyor.stiffness) ** (-0.5 / conveyor.exponent),
    )
    if run.status == "ok":
        check(run, 1e-9)
    elif run.status == "not finite":
        depth = plate_motion(conveyor, np.zeros(1))["z"][0] - (start.z if start.z != "conveyor" else math.inf)
        assert depth > 1.0  # m: its spring overflows
    else:
        assert run.status in ("contact too stiff", "too many events")
        assert rate / conveyor.frequency > 1e4
        assert math.isnan(run.z_end)


@settings(max_examples=150, deadline=None, phases=NO_SHRINKING, suppress_health_check=[HealthCheck.too_slow])
@given(st.one_of(conveyors, st.builds(tilt, conveyors, *TRACK)), starts)
# Found by this test: a root lost to cancellation, slip reversals without end, a stick that outlived its friction,
# a force whose series did not converge, sticking and slipping at rest without end, a separation next to the start.
@example(
    Conveyor(acceleration=2.2e-16, angle=0.75, frequency=124.0, psi0=1e-15, damping=0.0, mass=1.6e-4),
    Start("conveyor", vz=-0.07),
)
@example(
    Conveyor(
        acceleration=6.103515625e-05,
        angle=5e-07,
        frequency=5.0,
        psi0=4.960348097102986,
        damping=0.0,
        friction=0.02090100655803669,
        mass=9.753803060417123e-05,
        exponent=1.0,
    ),
    Start(z=-4.3e-54),
)
@example(
    Conveyor(acceleration=51.0, angle=5e-324, frequency=339.0, stiffness=6e4, friction=1.45, mass=2.2e-3, exponent=1.9),
    Start("conveyor"),
)
@example(
    Conveyor(
        acceleration=3.8,
        angle=0.835,
        frequency=17.6,
        psi0=2.12,
        stiffness=2.32e5,
        damping=0.375,
        exponent=1.15,
        tension="clip",
    ),
    Start("conveyor", vz=0.412),
)
@example(Conveyor(acceleration=0.0, angle=0.0, frequency=7.39, damping=0.0, exponent=1.0), Start("conveyor"))
@example(
    Conveyor(
        acceleration=5e-324,
        angle=0.10073910016816946,
        frequency=6.2835071969381815,
        psi0=5.16947249338495,
        stiffness=492463.4220389999,
        damping=3.0,
        friction=0.15,
        mass=0.0007000000000093406,
        exponent=2.057880883881108,
        tension="frictionless",
    ),
    Start(z=-1.8827764430134195e-65, vz=0.4113990765231621),
)
@example(
    Conveyor(
        acceleration=79.4690520074417,
        angle=0.01,
        frequency=278.83430837729395,
        psi0=3.793713574955103,
        stiffness=249154.80776273232,
        damping=0.2382365126085746,
        mass=0.000555885196086674,
        exponent=2.0,
    ),
    Start(z=-2.2250738585e-313, vz=-0.0988428044562999),
)
@example(
    Conveyor(
        acceleration=5.5098383852502805e-294,
        angle=0.2579561182693924,
        frequency=9.20538288096514,
        psi0=3.3956519001046797,
        damping=0.0,
        mass=0.001130736797650768,
        exponent=1.0,
    ),
    Start(z=-3.0002967305539988e-276, vz=0.6268767624463796),
)
def test_any_run_ends_with_a_finite_motion_above_the_plate(conveyor, start):
    run = simulate(conveyor, start, duration=0.2, tolerance=1e-9)
    assert run.status == "ok"
    check(run, 1e-9)


@pytest.mark.parametrize("acceleration", [0.0, 20.0, 35.0])
def test_the_deepest_penetration_is_that_of_a_drop(acceleration):
    """An undamped part dropped on a plate with constant acceleration: the spring stores the work m (g + a) (h + δ).

    From its lowest point on, 1 Hz, the plate's acceleration stays at a during the drop, to 1 - cos(0.04).
    """
    conveyor = Conveyor(acceleration=acceleration, angle=0.5 * math.pi, frequency=1.0, damping=0.0)
    pull, height = conveyor.gravity + acceleration, 3e-4
    start = Start(z=height - acceleration / (2.0 * math.pi) ** 2)
    allowed = deepest_allowed(pack(conveyor, start)[None], np.array([height]))[0]
    work = conveyor.mass * pull * (height + allowed)
    assert conveyor.stiffness * allowed**2.5 / 2.5 == pytest.approx(work, rel=1e-12)
    times = np.linspace(0.0, 1.5 * math.sqrt(2.0 * height / pull), 20_001)
    run = simulate(conveyor, start, duration=times[-1], tolerance=1e-12)
    depth = plate_motion(conveyor, times)["z"] - run.sample(times)["z"]
    assert depth.max() == pytest.approx(allowed, rel=1e-3)
    assert depth.max() <= allowed * (1.0 + 1e-9)


def test_four_thousand_random_points():
    for draw, wanted in ((around_the_paper, 1.0), (whole_ranges, 0.5)):
        points = draw(1000, seed=1)
        parameters = np.concatenate([points, tilted(points, seed=2)])
        columns = ensemble.sweep(parameters, duration=3.0 / parameters[:, FREQUENCY], tolerance=1e-8, threads=2)
        ok = columns["status"] == "ok"
        assert ok.mean() >= wanted
        assert "impact not found" not in columns["status"]
        for name in ensemble.COLUMNS:
            assert np.isfinite(columns[name][ok]).all()


# Of the million points of whole_ranges(1_000_000, seed=1), these fourteen ended as "too many events" in an earlier
# version: at the end of a contact, the slip velocity was zero up to rounding, and a false reversal was found ten
# thousand times.
HARDLY_MOVED = Path(__file__).with_name("hardly_moved.csv")


def test_no_slip_reversal_without_a_change_of_direction():
    for parameters in np.loadtxt(HARDLY_MOVED, delimiter=","):
        conveyor, start = unpack(parameters)
        run = simulate(conveyor, start, duration=10.0 / conveyor.frequency, tolerance=1e-8)
        assert run.status == "ok"
        check(run, 1e-8)
        # Of what happens between two contacts with the plate, slip turns at most a few times.
        turned = (run.events["kind"] == "slip reversal").sum()
        assert turned <= 3 * (run.impacts + 1) + 20


def test_rows_do_not_depend_on_how_the_work_is_shared():
    parameters = around_the_paper(60, seed=2)
    first = ensemble.sweep(parameters, duration=0.1, threads=1, chunk=60)
    for threads, chunk in ((2, 7), (1, 1), (2, 64)):
        again = ensemble.sweep(parameters, duration=0.1, threads=threads, chunk=chunk)
        assert all(first[name].tobytes() == again[name].tobytes() for name in first)
