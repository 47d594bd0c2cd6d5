"""The public interface: its examples run, and no odd argument makes it hang, give NaN with "ok" or a nameless error."""

import doctest
import inspect
import random
import signal

import numpy as np
import pytest

import conveyor
from conveyor import Conveyor, Start, ensemble, interface, simulation
from conveyor.analysis.bifurcations import periodic_orbits
from conveyor.analysis.chaos import lyapunov
from conveyor.parameters import PARAMETERS, RANGES
from conveyor.solver.model import pack

ODD = (
    *(float("nan"), float("inf"), -float("inf"), None, 1e308, -1e308, -1, 0, 10**30, 1e-308, True, 1j),
    *(np.timedelta64(3, "s"), np.float32(0.25), np.longdouble(0.25)),
    *("", "event", "conveyor", b"x", [], {}, (), object()),
    *(
        np.array([]),
        np.array([np.nan, 1.0]),
        np.zeros((2, 3, 4)),
        np.array(["a"]),
        np.array([None]),
        [[1.0], [1.0, 2.0]],
    ),
)
CONVEYOR = Conveyor(static_friction=0.15)
SECONDS = 20  # a call takes at most about two, once its kernels are compiled
ORBIT = interface.periodic_orbit(Conveyor(), Start(3e-4), transient=100)
POINTS = np.random.default_rng(1).random((200, 2))
NUMBERS = [*(name for name in RANGES if name not in ("z0", "vz0"))]
# Arguments with which each function is quick.
FUNCTIONS = {
    "simulate": {"conveyor": Conveyor(), "start": Start(), "duration": 0.02, "method": "event", "tolerance": 1e-8}
    | {"step": 1e-5, "reuse": True},
    "sweep": {"conveyor": Conveyor(), "start": Start(), "duration": 0.02, "method": "euler", "tolerance": 1e-8}
    | {"step": 1e-5, "threads": 1, "z": [0.0, 1e-4], "acceleration": 40.0},
    "classify": {"conveyor": Conveyor(), "start": Start(), "cycles": 10, "tolerance": 1e-8, "threads": 1}
    | dict.fromkeys(("z", "vz"), 0.0)
    | {name: getattr(CONVEYOR, name) for name in NUMBERS},
    "lyapunov_spectrum": {"conveyor": Conveyor(), "start": Start(), "transient": 10, "cycles": 5, "blocks": 2}
    | {"tolerance": 1e-8, "threads": 1, "psi0": 0.0, "damping": 0.3},
    "periodic_orbit": {"conveyor": Conveyor(), "start": Start(), "period": 1, "transient": 10},
    "continue_orbit": {"conveyor": Conveyor(), "orbit": ORBIT, "low": 39.99, "high": 40.01},
    "basin": {"conveyor": Conveyor(), "z": [0.0, 1e-4], "vz": 0.0, "cycles": 10, "tolerance": 1e-8, "threads": 1},
    "box_dimension": {"points": POINTS},
    "correlation_dimension": {"points": POINTS, "theiler": 0},
    "Conveyor": {name: getattr(CONVEYOR, name) for name in (*NUMBERS, "tension")},
    "Start": {"z": 0.0, "vz": 0.0},
}
# A perturbation underflows within one cycle.
OVERDAMPED = {
    "frequency": 7.14,
    "angle": 0.056,
    "acceleration": 51.8,
    "damping": 1.12,
    "mass": 1.45e-4,
    "exponent": 1.0,
}
RUN = simulation.simulate(Conveyor(), duration=0.02)
METHODS = {"mean_velocity": {"last": 0.5}, "sample": {"times": [0.0, 0.01]}}


@pytest.fixture(scope="module", autouse=True)
def compiled():
    """To compile takes longer than any call may."""
    for name, arguments in FUNCTIONS.items():
        getattr(conveyor, name)(**arguments)
    conveyor.classify(Conveyor(), cycles=10, acceleration=[80.0] * 8)


def call(function, name, arguments, changed):
    """Call a function with odd arguments; an error must name one of them, a result must not hide a NaN."""

    def stop(*_):
        raise AssertionError(f"{name} hangs for {changed}")

    signal.signal(signal.SIGALRM, stop)
    signal.alarm(SECONDS)
    try:
        found = function(**arguments | changed)
    except (ValueError, TypeError) as error:
        assert any(argument in str(error) for argument in changed), f"{name} does not name {changed}: {error}"
        return
    finally:
        signal.alarm(0)
    status = getattr(found, "status", None)
    if status is not None:
        for field in set(found._fields if hasattr(found, "_fields") else ()) - {"status"}:
            assert not (np.isnan(getattr(found, field)) & (np.asarray(status) == "ok")).any(), (name, changed, field)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_odd_arguments_are_named(name):
    arguments = FUNCTIONS[name]
    function = getattr(conveyor, name)
    for argument in arguments:
        for odd in ODD:
            call(function, name, arguments, {argument: odd})
    call(function, name, arguments, {"accelerations": 1.0})
    generator = random.Random(name)
    for _ in range(30):
        chosen = generator.sample(list(arguments), k=min(2, len(arguments)))
        call(function, name, arguments, {argument: generator.choice(ODD) for argument in chosen})


@pytest.mark.parametrize("name", METHODS)
def test_odd_arguments_of_a_run_are_named(name):
    for argument in METHODS[name]:
        for odd in ODD:
            call(getattr(RUN, name), name, METHODS[name], {argument: odd})


@pytest.mark.parametrize(
    "extreme", [OVERDAMPED, {"damping": 1e6, "mass": 1e-12}, {"damping": 0.0}, {"acceleration": 0.0}]
)
def test_no_exponent_is_missing_without_a_reason(extreme):
    call(conveyor.lyapunov_spectrum, "lyapunov_spectrum", FUNCTIONS["lyapunov_spectrum"], extreme)


@pytest.mark.parametrize("module", [interface, simulation])
def test_examples(module):
    found = doctest.testmod(module, extraglobs={"Conveyor": Conveyor, "Start": Start, "np": np})
    assert found.attempted > 0
    assert not found.failed


def test_every_public_function_has_an_example():
    for name in conveyor.__all__:
        public = getattr(conveyor, name)
        if inspect.isfunction(public):
            assert ">>>" in public.__doc__, name


def test_arrays_broadcast_and_results_have_their_shape():
    heights = np.array([0.0, 3e-4])
    runs = conveyor.sweep(Conveyor(), duration=0.1, acceleration=np.array([20.0, 40.0, 50.0])[:, None], z=heights)
    assert {field.shape for field in runs} == {(3, 2)}
    one = conveyor.simulate(Conveyor(acceleration=50.0), Start(3e-4), duration=0.1)
    assert runs.z_end[2, 1] == one.z_end
    assert runs.mean_velocity[2, 1] == one.mean_velocity()
    assert conveyor.sweep(Conveyor(), duration=0.1).status.shape == ()


def test_the_conveyor_keeps_its_static_friction_where_friction_is_swept():
    sticky = Conveyor(acceleration=3.0, friction=0.05, static_friction=0.4)
    runs = conveyor.sweep(sticky, duration=0.2, friction=[0.05, 0.1])
    alone = conveyor.sweep(Conveyor(acceleration=3.0, friction=0.1, static_friction=0.4), duration=0.2)
    assert runs.x_end[1] == alone.x_end
    assert runs.x_end[1] != conveyor.sweep(Conveyor(acceleration=3.0, friction=0.1), duration=0.2).x_end


def test_a_basin_has_the_labels_of_its_initial_conditions():
    heights, speeds = np.linspace(0.0, 5e-4, 6), np.array([-0.05, 0.05])
    found = conveyor.basin(Conveyor(), heights, speeds)
    alone = conveyor.classify(Conveyor(), z=heights[:, None], vz=speeds)
    assert (found.state == alone.state).all()
    assert (found.period == alone.period).all()
    assert set(found.state.flat) == {"first", "second"}


ROWS = np.array([pack(Conveyor(), Start(3e-4)), pack(Conveyor(acceleration=80.0), Start())])
# Functions below the public interface that check their arguments themselves.
INNER = {
    ensemble.run: {"parameters": ROWS, "duration": 0.01, "method": "event", "tolerance": 1e-8, "step": 1e-5}
    | {"needs": "vertical", "threads": 1, "chunk": 10},
    lyapunov.spectrum: {"parameters": ROWS, "states": np.zeros((2, 2)), "transient": 5, "cycles": 5, "blocks": 2}
    | {"tolerance": 1e-8, "threads": 1},
    periodic_orbits.find_orbit: {"parameters": ROWS[0], "acceleration": 40.0, "state": ORBIT.state, "period": 1},
}


def changed_rows(parameter, value):
    """Packed parameters with a value of one parameter in the last row."""
    rows = ROWS.copy()
    rows[-1, PARAMETERS.index(parameter)] = value
    return rows


@pytest.mark.parametrize("function", INNER, ids=lambda function: function.__name__)
def test_odd_arguments_of_inner_functions_are_named(function):
    arguments = INNER[function]
    function(**arguments)  # to compile takes longer than any call may
    for argument in arguments:
        for odd in ODD:
            call(function, function.__name__, arguments, {argument: odd})


@pytest.mark.parametrize("function", INNER, ids=lambda function: function.__name__)
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e308, -1e308, -1.0])
def test_packed_parameters_are_checked(function, value):
    """Each parameter of a row has its range; -1 lies within those of some."""
    for parameter in PARAMETERS:
        rows = changed_rows(parameter, value)
        rows = rows[-1] if function is periodic_orbits.find_orbit else rows
        if value == -1.0 and (RANGES.get(parameter, (0.0,))[0] <= value):
            continue
        if np.isnan(value) and parameter in ("z0", "vz0"):
            continue  # a part that starts on the plate, and one whose last run failed
        with pytest.raises(ValueError, match=rf"parameters\[\d\]: {parameter} = .* is outside \["):
            function(**INNER[function] | {"parameters": rows})


def test_a_run_that_continues_a_failed_one_fails():
    found = ensemble.run(changed_rows("vz0", np.nan), duration=0.01)
    assert found["status"].tolist() == ["ok", "impact not found"]


def test_exponents_over_more_cycles_than_memory_holds_are_refused():
    with pytest.raises(ValueError, match=r"blocks = 10000 of cycles = 1000000 for 2 trajectories"):
        lyapunov.spectrum(ROWS, cycles=10**6, blocks=10**4)


def test_shapes_of_packed_parameters_and_states_are_checked():
    with pytest.raises(ValueError, match=r"parameters must have the shape \(n, 16\), got the shape \(2, 15\)"):
        ensemble.run(ROWS[:, 1:])
    with pytest.raises(ValueError, match=r"states must have the shape \(2, 2\)"):
        lyapunov.spectrum(ROWS, np.zeros((1, 2)))
    with pytest.raises(ValueError, match=r"state must be δ \(m\) and v \(m/s\)"):
        periodic_orbits.find_orbit(ROWS[0], 40.0, np.zeros(3), 1)


@pytest.mark.parametrize("method", ["event", "euler"])
@pytest.mark.parametrize("kind", [np.float32, np.longdouble, np.float64])
def test_numbers_of_any_type_give_the_run_of_their_values(kind, method):
    numbers = {"duration": kind(0.0625), "tolerance": kind(2.0**-24), "step": kind(2.0**-16)}
    run, same = (
        conveyor.simulate(Conveyor(), Start(3e-4), method=method, **options)
        for options in (numbers, {name: float(value) for name, value in numbers.items()})
    )
    assert run == same
    assert run.mean_velocity(kind(0.5)) == same.mean_velocity(0.5)


@pytest.mark.parametrize("changed", [{"multipliers": 1.0}, {"multipliers": ("a", "b")}, {"impacts": [1, 2]}])
def test_an_orbit_with_odd_fields_is_named(changed):
    with pytest.raises(ValueError, match=f"orbit.{next(iter(changed))}"):
        conveyor.continue_orbit(Conveyor(), ORBIT._replace(**changed), low=39.99, high=40.01)


def test_an_orbit_of_another_conveyor_is_refused():
    with pytest.raises(ValueError, match="orbit is no orbit of this conveyor"):
        conveyor.continue_orbit(Conveyor(damping=0.31), ORBIT, low=39.99, high=40.01)


def test_a_branch_has_only_orbits_and_bifurcations_between_its_ends():
    """The period doubles at 54.218 m/s², less than a step of the branch beyond the first end."""
    ends = {}
    for high in (54.2, 54.22):
        branch = conveyor.continue_orbit(Conveyor(), ORBIT, low=39.9, high=high)
        assert 39.9 <= branch.orbits[0].acceleration < 40.0
        assert high - 0.1 <= branch.orbits[-1].acceleration <= high
        ends[high] = [point.kind for point in branch.bifurcations]
    assert ends == {54.2: [], 54.22: ["period_doubling"]}


def test_a_sweep_has_one_duration():
    with pytest.raises(ValueError, match="duration"):
        conveyor.sweep(Conveyor(), duration=[1.0, 2.0], z=[0.0, 0.0])


def test_a_run_that_fails_has_no_numbers():
    """Its time constant m/d_c is far too short to follow."""
    runs = conveyor.sweep(Conveyor(damping=1e6), Start(-1e-3), duration=0.01)
    single = conveyor.simulate(Conveyor(damping=1e6), Start(-1e-3), duration=0.01)
    assert runs.status == single.status == "contact too stiff"
    for name in set(runs._fields) - {"status", "impacts", "mean_velocity"}:
        assert np.isnan(getattr(runs, name)) and np.isnan(getattr(single, name)), name
    assert np.isnan(runs.mean_velocity) and np.isnan(single.mean_velocity())


def test_the_larger_exponent_is_the_first_one():
    """At rest both are equal but for what a hundred cycles leave of the first tangent vector."""
    found = conveyor.lyapunov_spectrum(Conveyor(), Start(1e-3), acceleration=[0.0, 5.0, 20.0])
    assert (found.lambda_1 >= found.lambda_2).all()


def test_infinite_points_of_single_precision_are_refused():
    with pytest.raises(ValueError, match="points = inf is outside"):
        conveyor.box_dimension(np.full((50, 2), np.inf, np.float32))
