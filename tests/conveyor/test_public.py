"""The public interface: its examples run, and no odd argument makes it hang, give NaN with "ok" or a nameless error."""

import copy
import doctest
import functools
import importlib
import inspect
import os
import random
import signal
import subprocess
import sys
import tomllib
from fnmatch import fnmatchcase
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import conveyor
from conveyor import Conveyor, Start, columns, parameter_table, replace_parameters, restart, simulation
from conveyor.analysis.attractors import search
from conveyor.analysis.attractors.attractor_table import NO_ATTRACTORS
from conveyor.analysis.chaos import lyapunov
from conveyor.interface import with_unknown
from conveyor.packing import as_rows
from conveyor.parameters import DEFAULT_TOLERANCE, PARAMETERS, RANGES
from conveyor_pipeline.common import fields

ODD = (
    *(float("nan"), float("inf"), -float("inf"), None, 1e308, -1e308, -1, 0, 10**30, 1e-308, True, 1j),
    *(np.timedelta64(3, "s"), np.float32(0.25), np.longdouble(0.25)),
    *("", "event", "conveyor", b"x", [], {}, (), object(), np.ma.masked, 5e-324),
    *(
        np.array([]),
        np.array([np.nan, 1.0]),
        np.zeros((2, 3, 4)),
        np.array(["a"]),
        np.array([None]),
        [[1.0], [1.0, 2.0]],
        np.zeros(0, [("z0", float)]),
    ),
)
CONVEYOR = Conveyor(static_friction=0.15)
HORIZONTAL = ("mean_velocity", "x_end", "vx_end")  # NaN where only the vertical motion is followed
SECONDS = 20  # a call takes at most about two, once its kernels are compiled
POINTS = np.random.default_rng(1).random((200, 2))
NUMBERS = [*(name for name in RANGES if name not in ("z0", "vz0"))]
TABLE = parameter_table(Conveyor(), z0=[0.0, 3e-4], acceleration=[40.0, 80.0])
# Arguments with which each function is quick; `arguments_of` adds an orbit.
FUNCTIONS = {
    "simulate": {"conveyor": Conveyor(), "start": Start(), "duration": 0.02, "method": "event", "tolerance": 1e-8}
    | {"step": 1e-5, "reuse": True},
    "parameter_table": {"conveyor": Conveyor(), "start": Start()}
    | dict.fromkeys(("z0", "vz0"), 0.0)
    | {name: getattr(CONVEYOR, name) for name in NUMBERS},
    "sweep": {"parameters": TABLE, "duration": 0.02, "method": "euler", "tolerance": 1e-8, "step": 1e-5}
    | {"needs": "vertical", "threads": 1, "chunk": 10},
    "transits": {"parameters": TABLE, "lengths": [1e-3], "longest": [0.05], "begin": 0.01, "tolerance": 1e-8}
    | {"threads": 1},
    "sample_runs": {"parameters": TABLE, "times": [[0.0, 0.01]] * 2, "columns": ["x"], "method": "event"}
    | {"vx0": 0.0}
    | {"tolerance": 1e-8, "step": 1e-5, "reuse": True, "threads": 1, "chunk": 10},
    "classify": {"parameters": TABLE, "cycles": 10, "exponents": True, "other_tolerance": 1e-9}
    | {"tolerance": 1e-8, "threads": 1},
    "attractors": {"conveyor": Conveyor(), "samples": 4, "cycles": 10, "tolerance": 1e-8, "threads": 1},
    "continue_bifurcation": {"parameter": "damping", "limits": (0.29, 0.31)},
    "bifurcation_diagram": {"parameters": TABLE, "transient": 2, "strobes": 2, "tolerance": 1e-8},
    "initial_states": {"parameters": TABLE, "tolerance": 1e-8},
    "strobes": {"conveyor": TABLE[0], "cycles": 3, "tolerance": 1e-8},
    "start_at": {"parameters": TABLE, "states": np.zeros((2, 2)), "tolerance": 1e-8},
    "groups_of": {"conveyor": TABLE[0]},
    "amplitude_of": {"conveyor": TABLE[0], "ratio": 1.0},
    "length_and_speed_units": {"conveyor": TABLE[0]},
    "uncertainty_exponent": {"labels": np.arange(1600).reshape(40, 40) % 7},
    "basin_entropy": {"labels": np.arange(1600).reshape(40, 40) % 7, "size": 4},
    "find_attractors": {"parameters": TABLE, "cycles": 10, "orbits": True, "tolerance": 1e-8, "threads": 1},
    "lyapunov_spectrum_on_attractors": {"parameters": TABLE, "cycles": 5, "blocks": 2, "tolerance": 1e-8, "threads": 1},
    "lyapunov_spectrum": {"parameters": TABLE, "states": np.zeros((2, 2)), "transient": 10, "cycles": 5, "blocks": 2}
    | {"tolerance": 1e-8, "threads": 1},
    "replace_parameters": {"parameters": TABLE, "acceleration": 40.0, "vz0": 0.0, "friction": 0.1, "tension": "clip"},
    "conveyor_and_start": {"parameters": TABLE[0]},
    "restart": {"parameters": TABLE, "z_end": [0.0, 1e-4], "vz_end": [0.0, 0.1], "duration": 0.5},
    "plate_motion": {"conveyor": Conveyor(), "times": [0.0, 0.1]},
    "harmonic_spectrum": {"samples": np.arange(8.0), "duration": 0.02},
    "windowed_spectrum": {"samples": np.arange(8.0), "duration": 0.02},
    "throw_number": {"acceleration": [40.0, 60.0], "angle": 0.2, "gravity": 9.81, "inclination": 0.0, "harmonics": ()},
    "throw_velocity": {"acceleration": [40.0, 60.0], "angle": 0.2, "gravity": 9.81, "inclination": 0.0}
    | {"frequency": 50.0, "phase_shift": 0.0},
    "find_doubled_orbit": {},
    "doubling_cascade": {},
    "doubling_ratios": {"amplitudes": [54.2, 61.2, 62.4, 62.7]},
    "accumulation_point": {"amplitudes": [54.2, 61.2, 62.4, 62.7]},
    "material": {"name": "steel"},
    "Block": {"length": 5e-3, "height": 1e-3, "inertia": 1e-6},
    "simulate_block": {"conveyor": Conveyor(), "block": conveyor.Block(5e-3, 1e-3), "start": Start(), "tilt": 0.01}
    | {"duration": 0.02, "tolerance": 1e-8},
    "block_transits": {"parameters": TABLE, "block": conveyor.Block(5e-3, 1e-3), "tilts": [0.0, 0.01], "length": 1e-3}
    | {"longest": 0.05, "begin": [0.01, 0.01], "tolerance": 1e-8, "threads": 1},
    "periodic_orbit": {"conveyor": Conveyor(), "start": Start(), "period": 1, "transient": 10},
    "continue_orbit": {"parameter": "acceleration", "limits": (39.99, 40.01)},
    "basin": {"conveyor": Conveyor(), "z": [0.0, 1e-4], "vz": 0.0, "cycles": 400, "tolerance": 1e-8, "threads": 1},
    "box_dimension": {"points": POINTS},
    "correlation_dimension": {"points": POINTS, "theiler": 0},
    "Conveyor": {name: getattr(CONVEYOR, name) for name in (*NUMBERS, "tension")},
    "Start": {"z": 0.0, "vz": 0.0},
    "restitution": {"conveyor": Conveyor(), "speed": 0.3},
    "damping_of": {"restitution": 0.5, "speed": 0.3, "conveyor": Conveyor()},
    "hertz_stiffness": {"part": "steel", "lining": (1e9, 0.4), "radius": 1e-3},
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
# Those of the second door have modules of their own.
SECOND_DOOR = {
    "find_attractors": search.find_attractors,
    "lyapunov_spectrum_on_attractors": lyapunov.lyapunov_spectrum_on_attractors,
}
ENVIRONMENT = os.environ | {"PYTHONPATH": str(Path(conveyor.__file__).parents[1])}
METHODS = {"mean_velocity": {"last": 0.5}, "sample": {"times": [0.0, 0.01]}}


@pytest.fixture(scope="module")
def orbit():
    return conveyor.periodic_orbit(Conveyor(), Start(3e-4), transient=100)


@functools.cache
def doubling():
    """The first period doubling of the paper's jumping motion."""
    orbit = conveyor.periodic_orbit(Conveyor(acceleration=54.2), Start(3e-4))
    return conveyor.continue_orbit(orbit, "acceleration", (54.1, 54.3)).bifurcations[0]


@functools.cache
def two_doublings():
    """Successive period doublings of a stiff contact, behind which the cascade is short."""
    orbit = conveyor.periodic_orbit(Conveyor(acceleration=47.2, stiffness=5e7), Start(3e-4))
    (first,) = conveyor.continue_orbit(orbit, "acceleration", (46.9, 47.5)).bifurcations
    doubled = conveyor.find_doubled_orbit(first)
    (second,) = conveyor.continue_orbit(doubled, "acceleration", (46.9, 57.0)).bifurcations
    return {"first": first, "second": second}


def function_of(name):
    """One of FUNCTIONS."""
    return SECOND_DOOR[name] if name in SECOND_DOOR else getattr(conveyor, name)


def arguments_of(name, orbit):
    """The arguments of one of FUNCTIONS."""
    more = {"continue_orbit": {"orbit": orbit}, "continue_bifurcation": {"bifurcation": doubling()}}
    more |= {"find_doubled_orbit": {"bifurcation": doubling()}}
    more |= {"doubling_cascade": two_doublings()}
    return FUNCTIONS[name] | more.get(name, {})


@pytest.fixture(scope="module", autouse=True)
def compiled(orbit):
    """To compile takes longer than any call may."""
    for name in FUNCTIONS:
        function_of(name)(**arguments_of(name, orbit))
    conveyor.classify(parameter_table(Conveyor(), acceleration=[80.0] * 8), cycles=10)


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
    if isinstance(found, conveyor.Columns) and "status" in found and "transits" not in name:  # NaN: a late part
        for field in set(found) - {"status", *(HORIZONTAL if "needs" in arguments else ())}:
            # The first axis of samples is the run.
            assert not (np.isnan(found[field]).T & (found.status == "ok")).any(), (name, changed, field)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_odd_arguments_are_named(name, orbit):
    arguments = arguments_of(name, orbit)
    function = function_of(name)
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
    run = simulation.simulate(Conveyor(), duration=0.02)
    for argument in METHODS[name]:
        for odd in ODD:
            call(getattr(run, name), name, METHODS[name], {argument: odd})


@pytest.mark.parametrize(
    "extreme", [OVERDAMPED, {"damping": 1e6, "mass": 1e-12}, {"damping": 0.0}, {"acceleration": 0.0}]
)
def test_no_exponent_is_missing_without_a_reason(extreme):
    arguments = {"parameters": parameter_table(Conveyor(), **extreme), "transient": 10, "cycles": 5, "blocks": 2}
    call(conveyor.lyapunov_spectrum, "lyapunov_spectrum", arguments, {})


LIBRARY = Path(conveyor.__file__).parent
MODULES = sorted(
    ".".join(file.relative_to(LIBRARY.parent).with_suffix("").parts)
    for file in LIBRARY.rglob("*.py")
    if ">>>" in file.read_text() and "certificates" not in file.parts
)


@pytest.mark.parametrize("module", MODULES)
def test_examples(module):
    """Examples may use the names of the front door and of their own module."""
    names = {name: getattr(conveyor, name) for name in conveyor.__all__}
    module = importlib.import_module(module)
    assert not doctest.testmod(module, extraglobs=names | {"np": np} | vars(module)).failed


def test_every_public_name_is_documented_and_every_function_has_an_example():
    for name in conveyor.__all__:
        public = getattr(conveyor, name)
        assert not callable(public) or public.__doc__, name
        assert not inspect.isfunction(public) or ">>>" in public.__doc__, name


def test_arrays_broadcast_and_results_have_their_shape():
    heights = np.array([0.0, 3e-4])
    parameters = parameter_table(Conveyor(), acceleration=np.array([20.0, 40.0, 50.0])[:, None], z0=heights)
    runs = conveyor.sweep(parameters, duration=0.1)
    assert {column.shape for column in runs.values()} == {(3, 2)}
    one = conveyor.simulate(Conveyor(acceleration=50.0), Start(3e-4), duration=0.1)
    assert runs.z_end[2, 1] == one.z_end
    assert runs.mean_velocity[2, 1] == one.mean_velocity()
    assert conveyor.sweep(parameter_table(Conveyor()), duration=0.1).status.shape == ()


def test_results_become_a_frame_with_their_parameters(tmp_path):
    parameters = parameter_table(Conveyor(), z0=[[0.0, 1e-4], [2e-4, 3e-4]])
    runs = conveyor.sweep(parameters, duration=0.1)
    frame = runs.to_frame(parameters)
    assert frame.z_end.tolist() == runs.z_end.ravel().tolist()
    assert frame.z0.tolist() == parameters["z0"].ravel().tolist()
    frame.to_parquet(tmp_path / "runs.parquet")
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / "runs.parquet"), frame)
    assert set(runs.units) == set(runs) <= set(dir(runs))
    with pytest.raises(ValueError, match="no common shape"):
        conveyor.sample_runs(TABLE, np.zeros((2, 3))).to_frame()
    with pytest.raises(ValueError, match="no common shape"):
        runs.to_frame(TABLE)


def test_an_unknown_column_is_named_with_the_known_ones():
    """Also in a copy, which Python makes without calling __init__."""
    columns = copy.copy(conveyor.Columns({"x_end": np.zeros(2), "vx_end": np.ones(2)}))
    with pytest.raises(AttributeError, match=r"there is no column 'velocity'; there are x_end, vx_end$"):
        _ = columns.velocity


def test_a_frame_has_the_harmonics_of_the_plate():
    harmonic = {"order": 3, "along": 0.2, "along_phase": np.pi / 2.0}
    wavy = parameter_table(Conveyor(harmonics=[harmonic]), acceleration=[50.0])
    frame = conveyor.Columns({"x_end": np.zeros(1)}).to_frame(wavy)
    assert frame.acceleration.tolist() == [50.0]
    assert frame.filter(like="harmonic_1").round(12).values.tolist() == [[3.0, 0.0, 0.2, 0.0, 0.0]]


def test_events_have_the_state_of_the_run():
    run = conveyor.simulate(Conveyor(), Start(3e-4), duration=0.5)
    impacts = run.events[run.events["kind"] == "impact"]
    assert len(impacts) == run.impacts
    plate, part = conveyor.plate_motion(Conveyor(), impacts["time"]), run.sample(impacts["time"])
    assert impacts["z"] == pytest.approx(plate["z"], abs=1e-12)
    assert (impacts["vz"] == part["vz"]).all()
    assert impacts["impact_speed"] == pytest.approx(plate["vz"] - part["vz"])
    last = impacts["time"] > 0.375
    assert impacts["impact_speed"][last].max() == pytest.approx(run.impact_speed, rel=1e-8)
    assert np.isnan(run.events["impact_speed"][run.events["kind"] == "separation"]).all()


def test_attractors_of_one_conveyor_are_told_apart():
    """At 50 m/s² and a damping of 0.1, three jumping motions coexist, one of them of 12 cycles."""
    tame = Conveyor(acceleration=50.0, damping=0.1)
    found = conveyor.attractors(tame, samples=64, cycles=2000)
    assert sorted(one.period for one in found.found) == [2, 4, 12]
    assert sum(one.share for one in found.found) == 1.0
    for one in found.found:
        assert one.orbit.stable
        row = conveyor.start_at(conveyor.replace_parameters(parameter_table(tame), psi0=-np.pi), one.strobes)
        labels = conveyor.classify(row, attractors=found)
        assert (labels.period == one.period).all()
        assert set(labels.attractor) == {found.found.index(one)}
        runs = conveyor.sweep(row[:1], duration=19.2)
        assert runs.mean_velocity[0] == pytest.approx(one.mean_velocity, abs=1e-4)
    frame = found.columns.to_frame()
    assert (frame.multiplier < 1.0).all()


def test_labels_say_whether_another_tolerance_confirms_them():
    table = parameter_table(Conveyor(), acceleration=[40.0, 80.0], z0=3e-4)
    assert conveyor.classify(table, other_tolerance=1e-11).confirmed.tolist() == [True, True]
    with pytest.raises(ValueError, match="other_tolerance"):
        conveyor.classify(table, other_tolerance=1.0)
    other = conveyor.attractors(Conveyor(), samples=8)
    with pytest.raises(ValueError, match="attractors are those of another conveyor"):
        conveyor.classify(table, attractors=other)


def test_a_curve_in_two_parameters_agrees_with_branches_at_its_ends():
    begin = conveyor.periodic_orbit(Conveyor(acceleration=50.0), Start(3e-4))
    for parameter, limits in (("damping", (0.25, 0.35)), ("angle", (0.18, 0.25)), ("mass", (6e-4, 8e-4))):
        curve = conveyor.continue_bifurcation(doubling(), parameter, limits)
        assert curve.status[[0, -1]].tolist() == ["limit", "limit"]
        assert sorted(curve[parameter][[0, -1]]) == pytest.approx(sorted(limits))
        high = curve.acceleration[-1]
        moved = conveyor.replace_parameters(begin.parameters, **{parameter: curve[parameter][-1]})
        orbit = conveyor.periodic_orbit(conveyor.replace_parameters(moved, acceleration=0.99 * high))
        (same,) = conveyor.continue_orbit(orbit, "acceleration", (0.98 * high, 1.01 * high)).bifurcations
        assert same.orbit.acceleration == pytest.approx(high, rel=1e-9)
    with pytest.raises(ValueError, match=r"limits\[0\] = 0.4 must be a number in"):
        conveyor.continue_bifurcation(doubling(), "damping", (0.4, 0.5))


def test_a_conveyor_may_stand_for_its_table():
    one = Conveyor(acceleration=40.0)
    assert conveyor.classify(one).state.item() == "first"
    assert conveyor.sweep(one, duration=0.1).impacts == conveyor.sweep(parameter_table(one), duration=0.1).impacts
    assert conveyor.lyapunov_spectrum(one, cycles=10, blocks=5).lambda_1.shape == ()
    assert conveyor.strobes(one, 3).shape == (3, 2)
    assert conveyor.groups_of(one) == conveyor.groups_of(parameter_table(one))


def test_units_of_results_are_those_of_the_tables():
    for field in (*fields.RESULTS, *fields.STATE, *fields.FEATURES):
        assert columns.UNITS[field.name] == field.metadata[b"unit"].decode(), field.name


def test_the_conveyor_keeps_its_static_friction_where_friction_is_swept():
    sticky = Conveyor(acceleration=3.0, friction=0.05, static_friction=0.4)
    parameters = parameter_table(sticky, friction=[0.05, 0.1])
    assert parameters["static_friction"].tolist() == [0.4, 0.4]
    assert parameter_table(Conveyor(), friction=[0.05, 0.1])["static_friction"].tolist() == [0.05, 0.1]


def test_a_basin_has_the_labels_of_its_initial_conditions():
    heights, speeds = np.linspace(0.0, 5e-4, 6), np.array([-0.05, 0.05])
    found = conveyor.basin(Conveyor(), heights, speeds)
    alone = conveyor.classify(parameter_table(Conveyor(), z0=heights[:, None], vz0=speeds))
    assert (found.state == alone.state).all()
    assert (found.period == alone.period).all()
    assert set(found.state.flat) == {"first", "second"}


CHECKED = (
    *("sweep", "sample_runs", "transits", "classify", "find_attractors", "lyapunov_spectrum"),
    "lyapunov_spectrum_on_attractors",
)


def changed_table(parameter, value):
    """A table with a value of one parameter in the last row."""
    table = TABLE.copy()
    table[parameter][-1] = value
    return table


@pytest.mark.parametrize("name", CHECKED)
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e308, -1e308, -1.0])
def test_tables_of_parameters_are_checked(name, value, orbit):
    """Each parameter of a row has its range; -1 lies within those of some."""
    for parameter in PARAMETERS:
        table = changed_table(parameter, value)
        if value == -1.0 and (RANGES.get(parameter, (0.0,))[0] <= value):
            continue
        if np.isnan(value) and parameter in ("z0", "vz0"):
            continue  # a part that starts on the plate, and one whose last run failed
        with pytest.raises(ValueError, match=rf"parameters.1.: {parameter} = .* is"):
            function_of(name)(**arguments_of(name, orbit) | {"parameters": table})


@pytest.mark.parametrize("masked", [np.ma.array([40.0, 60.0], mask=[False, True]), np.ma.masked])
def test_a_masked_value_is_no_number(masked):
    with pytest.raises(ValueError, match=r"acceleration has masked values; leave them out$"):
        parameter_table(Conveyor(), acceleration=masked)
    whole = np.ma.array([40.0, 60.0], mask=False)
    assert parameter_table(Conveyor(), acceleration=whole)["acceleration"].tolist() == [40.0, 60.0]


def test_an_error_shows_no_unit_where_there_is_none():
    with pytest.raises(ValueError, match=r"friction = -1 must be a number in \[0, 10\]$"):
        Conveyor(friction=-1)
    with pytest.raises(ValueError, match=r"angle = 20.0 must be a number in \[0, 1.5708\] rad$"):
        Conveyor(angle=20.0)
    with pytest.raises(ValueError, match=r"duration = -1.0 is outside \[0, 1e\+06\] s$"):
        conveyor.restart(Conveyor(), 0.0, 0.0, -1.0)


@pytest.mark.parametrize("name", CHECKED)
def test_contradictions_in_a_table_are_named(name, orbit):
    for parameter, value, words in (
        ("tension", 7.0, "tension = 7.0 is outside"),
        (
            "tension",
            0.5,
            r"tension = 0.5 must be a position in TENSION_MODES: 0 \(allow\), 1 \(frictionless\), 2 \(clip\)",
        ),
        ("static_friction", 0.1, "static_friction = 0.1 is below friction = 0.15"),
    ):
        with pytest.raises(ValueError, match=rf"parameters\[1\]: {words}"):
            function_of(name)(**arguments_of(name, orbit) | {"parameters": changed_table(parameter, value)})
    wavy = parameter_table(Conveyor(harmonics=[{"order": 2, "along": 0.1}]), z0=[[0.0, 1e-4], [2e-4, 3e-4]])
    wavy["harmonics"][1, 0, 1] = np.nan
    with pytest.raises(ValueError, match=r"parameters\[1, 0\]: harmonics = nan is outside"):
        conveyor.sweep(wavy, duration=0.01)


@pytest.mark.parametrize("method", ["event", "euler"])
def test_times_of_samples_ascend(method):
    times = np.array([[0.0, 0.01], [0.01, 0.0]])
    with pytest.raises(ValueError, match="times must ascend in each row"):
        conveyor.sample_runs(TABLE, times, method=method)
    with pytest.raises(ValueError, match=r"times must have the shape \(2, k\)"):
        conveyor.sample_runs(TABLE, times[0])


@pytest.mark.parametrize("acceleration", [0.0, 46.5])
def test_no_part_touches_the_plate_for_longer_than_its_run(acceleration):
    """The durations of the pieces add up to slightly more than the run: 1.0000000000000004 at 46.5 m/s²."""
    parameters = parameter_table(Conveyor(acceleration=acceleration), z0=[0.0, 0.0, 0.0], psi0=[0.0, 1.0, 3.0])
    parameters["z0"] = np.nan  # on the plate
    for duration in (0.3, 0.7, 1.0):
        assert (conveyor.sweep(parameters, duration=duration).contact_fraction <= 1.0).all()
    spectrum = lyapunov.lyapunov_spectrum_on_attractors(parameters, cycles=20, blocks=5)
    assert (spectrum.contact_fraction <= 1.0).all()
    assert (conveyor.lyapunov_spectrum(parameters, cycles=20, blocks=5).contact_fraction <= 1.0).all()


def test_diagrams_of_several_lines_are_those_of_each_line():
    table = parameter_table(Conveyor(), damping=[[0.2], [0.3]], acceleration=[50.0, 57.0, 80.0], z0=3e-4)
    options = {"transient": 100, "strobes": 3}
    both = conveyor.bifurcation_diagram(table, threads=2, **options)
    for k in range(2):
        alone = conveyor.bifurcation_diagram(table[k], **options)
        assert all((both[name][k] == alone[name]).all() for name in alone)
    assert both.delta.shape == (2, 3, 3) and both.status.shape == (2, 3)


def test_a_row_of_a_table_may_stand_for_its_conveyor():
    row = parameter_table(Conveyor(acceleration=50.0), z0=[0.0, 3e-4])[1]
    same = Conveyor(acceleration=50.0, static_friction=0.15)
    run = conveyor.simulate(row, duration=0.1)
    assert (run.conveyor, run.start) == (same, Start(3e-4))
    assert run == conveyor.simulate(same, Start(3e-4), duration=0.1)
    assert conveyor.simulate_block(row, conveyor.Block(5e-3, 1e-3), duration=0.02).start == Start(3e-4)
    assert conveyor.conveyor_and_start(Conveyor()) == (CONVEYOR, Start())
    assert conveyor.replace_parameters(Conveyor(), acceleration=50.0)["acceleration"] == 50.0


def test_signatures_have_one_style():
    """Functions of tables take tolerance, threads and progress, by name, with the same defaults."""
    defaults = {"tolerance": DEFAULT_TOLERANCE, "threads": 1, "progress": None}
    blocks = {"simulate_block", "block_transits"}  # which have a tolerance of their own
    for name in conveyor.__all__:
        function = getattr(conveyor, name)
        given = inspect.signature(function).parameters if inspect.isfunction(function) else {}
        for option in defaults.keys() & given.keys():
            assert given[option].kind == inspect.Parameter.KEYWORD_ONLY, (name, option)
            assert given[option].default == defaults[option] or name in blocks, (name, option)
        assert ("threads" in given) <= ("progress" in given), name


def test_long_functions_show_one_bar(orbit, capsys):
    conveyor_80, table = Conveyor(acceleration=80.0), parameter_table(Conveyor(), z0=[0.0, 3e-4])
    calls = {
        "attractors": lambda label: conveyor.attractors(conveyor_80, samples=8, cycles=400, progress=label),
        "basin": lambda label: conveyor.basin(conveyor_80, [0.0, 3e-4], cycles=400, progress=label),
        "classify": lambda label: conveyor.classify(table, other_tolerance=1e-8, progress=label),
        "strobes": lambda label: conveyor.strobes(conveyor_80, 50_000, progress=label),
        "bifurcation_diagram": lambda label: conveyor.bifurcation_diagram(table, strobes=2, progress=label),
        "continue_orbit": lambda label: conveyor.continue_orbit(orbit, "acceleration", (39.9, 40.1), progress=label),
        "continue_bifurcation": lambda label: conveyor.continue_bifurcation(
            doubling(), "damping", (0.25, 0.35), progress=label
        ),
        "doubling_cascade": lambda label: conveyor.doubling_cascade(**two_doublings(), progress=label),
    }
    for name, call in calls.items():
        call(name)
        shown = [line for line in capsys.readouterr().err.splitlines() if f"{name}:" in line]
        assert len(shown) == 1, (name, shown)
        done, _, total = shown[0].split()[1:4]
        assert total.startswith(("?", done)), shown


INTERRUPTED = """
import os, signal, threading, numpy as np
from conveyor import *
signal.signal(signal.SIGINT, signal.default_int_handler)  # shells let background jobs ignore it
table = parameter_table(Conveyor(), acceleration=[80.0, 81.0], z0=3e-4)
calls = {
    "bifurcation_diagram": lambda n: bifurcation_diagram(table, transient=n, strobes=2, tolerance=1e-10),
    "strobes": lambda n: strobes(table[0], n),
    "periodic_orbit": lambda n: periodic_orbit(Conveyor(acceleration=80.0), transient=n),
    "lyapunov_spectrum": lambda n: lyapunov_spectrum(table, transient=n, cycles=5, blocks=2),
    "classify": lambda n: classify(table, cycles=10 * n),
    "euler": lambda n: simulate(Conveyor(), duration=1e-3 * n, method="euler"),
    "block": lambda n: simulate_block(Conveyor(), Block(5e-3, 1e-3), duration=1e-3 * n),
}
for name, call in calls.items():
    call(10)
    threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT)).start()
    try:
        call(100_000)
    except BaseException as error:
        print(name, type(error).__name__)
"""


def test_an_interrupt_stays_one():
    """Numba runs Python code where a compiled function returns an array, and would raise a SystemError there."""
    run = subprocess.run(
        [sys.executable, "-c", INTERRUPTED], capture_output=True, text=True, check=True, env=ENVIRONMENT
    )
    assert {line.split()[1] for line in run.stdout.splitlines()} == {"KeyboardInterrupt"}, run.stdout
    assert len(run.stdout.splitlines()) == 7


def test_every_name_can_be_looked_up_without_extras():
    code = """
import inspect, sys
sys.modules["pymoo"] = sys.modules["flint"] = sys.modules["pandas"] = None
import conveyor
from conveyor import *
assert all(hasattr(conveyor, name) for name in conveyor.__all__)
inspect.getmembers(conveyor)
help(conveyor)
"""
    subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, env=ENVIRONMENT)


def test_missing_interval_arithmetic_is_named():
    code = 'import sys; sys.modules["flint"] = None; import conveyor.certificates as c; c.prove_orbit'
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=ENVIRONMENT)
    assert run.stderr.splitlines()[-1].endswith('by pip install ".[certificates]"'), run.stderr


def test_numba_without_its_compiler_is_refused_in_a_sentence():
    environment = ENVIRONMENT | {"NUMBA_DISABLE_JIT": "1"}
    code = "from conveyor import simulate"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
    assert "NUMBA_DISABLE_JIT is set" in run.stderr.splitlines()[-1]
    assert "intrinsic" not in run.stderr


def test_exponents_over_more_cycles_than_memory_holds_are_refused():
    with pytest.raises(ValueError, match=r"blocks = 10000 of cycles = 1000000 for 2 trajectories"):
        conveyor.lyapunov_spectrum(TABLE, cycles=10**6, blocks=10**4)


def test_shapes_of_parameters_and_states_are_checked():
    with pytest.raises(ValueError, match=r"parameters must be a table from parameter_table, got the shape \(2, 15\)"):
        conveyor.sweep(np.zeros((2, 15)))
    with pytest.raises(ValueError, match="duration"):
        conveyor.sweep(TABLE, duration=[1.0, 2.0, 3.0])
    with pytest.raises(ValueError, match=r"states must have the shape \(2, 2\)"):
        conveyor.lyapunov_spectrum(TABLE, np.zeros((1, 2)))
    with pytest.raises(ValueError, match=r"start must have the shape \(2,\), δ \(m\) and v \(m/s\)"):
        conveyor.periodic_orbit(TABLE[0], np.zeros(3))
    with pytest.raises(ValueError, match=r"conveyor must be one row of a table, got the shape \(2,\)"):
        conveyor.periodic_orbit(TABLE)


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
def test_an_orbit_with_odd_fields_is_named(changed, orbit):
    with pytest.raises(ValueError, match=f"orbit.{next(iter(changed))}"):
        conveyor.continue_orbit(orbit._replace(**changed), "acceleration", (39.99, 40.01))


def test_an_orbit_of_another_conveyor_is_refused(orbit):
    other = orbit._replace(parameters=parameter_table(Conveyor(damping=0.31)))
    with pytest.raises(ValueError, match="orbit is no orbit of its conveyor"):
        conveyor.continue_orbit(other, "acceleration", (39.99, 40.01))


def test_a_branch_has_only_orbits_and_bifurcations_between_its_ends(orbit):
    """The period doubles at 54.218 m/s², less than a step of the branch beyond the first end."""
    ends = {}
    for high in (54.2, 54.22):
        branch = conveyor.continue_orbit(orbit, "acceleration", (39.9, high))
        assert 39.9 <= branch.orbits[0].acceleration < 40.0
        assert high - 0.1 <= branch.orbits[-1].acceleration <= high
        ends[high] = [point.kind for point in branch.bifurcations]
    assert ends == {54.2: [], 54.22: ["period_doubling"]}


def test_a_run_that_fails_has_no_numbers():
    """Its time constant m/d_c is far too short to follow."""
    runs = conveyor.sweep(parameter_table(Conveyor(damping=1e6), Start(-1e-3)), duration=0.01)
    single = conveyor.simulate(Conveyor(damping=1e6), Start(-1e-3), duration=0.01)
    assert runs.status == single.status == "contact too stiff"
    for name in set(runs) - {"status", "impacts", "mean_velocity"}:
        assert np.isnan(runs[name]) and np.isnan(getattr(single, name)), name
    assert np.isnan(runs.mean_velocity) and np.isnan(single.mean_velocity())


def test_the_larger_exponent_is_the_first_one():
    """At rest both are equal but for what a hundred cycles leave of the first tangent vector."""
    found = conveyor.lyapunov_spectrum(parameter_table(Conveyor(), Start(1e-3), acceleration=[0.0, 5.0, 20.0]))
    assert (found.lambda_1 >= found.lambda_2).all()


def test_infinite_points_of_single_precision_are_refused():
    with pytest.raises(ValueError, match="points = inf is outside"):
        conveyor.box_dimension(np.full((50, 2), np.inf, np.float32))


def test_pip_installs_the_library_alone():
    project = Path(conveyor.__file__).parents[2] / "pyproject.toml"
    patterns = tomllib.loads(project.read_text())["tool"]["setuptools"]["packages"]["find"]["include"]
    names = ("conveyor", "conveyor.solver", "conveyor_pipeline", "conveyor_pipeline.common")
    assert [name for name in names if any(fnmatchcase(name, pattern) for pattern in patterns)] == list(names[:2])


@pytest.mark.parametrize(
    "change", [lambda row: replace_parameters(row, friction=0.5), lambda row: restart(row, 5e-4, 0.0, 0.013)]
)
def test_a_changed_row_leaves_its_table_as_it_was(change):
    table = parameter_table(Conveyor(), z0=[0.0, 1e-4])
    before = table.copy()
    change(table[1])
    assert (table == before).all()


@pytest.mark.parametrize(
    "change", [lambda rows: replace_parameters(rows, friction=0.5), lambda rows: restart(rows, 5e-4, 0.0, 0.013)]
)
def test_a_change_of_a_wrong_table_names_row_and_column(change):
    table = parameter_table(Conveyor(), z0=[0.0, 1e-4])
    table["damping"][1] = -1.0
    with pytest.raises(ValueError, match=r"parameters\[1\]: damping = -1"):
        change(table)


def test_a_chaotic_transient_in_which_no_sample_ends_is_no_attractor():
    values = {"acceleration": 135.7290304644223, "angle": 0.3928751343577895, "frequency": 19.53152832773523}
    values |= {"stiffness": 1196669.073363716, "damping": 0.01625011717810182, "mass": 0.005403317227543452}
    found = conveyor.attractors(Conveyor(**values, exponent=2.0, tension="clip"), samples=16, cycles=4000).found
    assert [(one.state, one.share, np.isfinite(one.mean_velocity)) for one in found] == [("chaos", 1.0, True)]


@pytest.mark.parametrize(("values", "known"), [({}, True), ({"friction": 1e-4}, False), ({"inclination": 0.3}, False)])
def test_an_attractor_has_a_mean_velocity_if_it_settles(values, known):
    """With little friction, parts still accelerate after 2048 cycles; on a steep track they slide away."""
    found = conveyor.attractors(Conveyor(**{"acceleration": 40.0, "friction": 0.15} | values), samples=32).found
    assert [(one.state, np.isfinite(one.mean_velocity)) for one in found] == [("second", known), ("first", known)]


def test_motions_without_a_known_chaotic_set_are_one_attractor():
    heights = parameter_table(Conveyor(acceleration=80.0), z0=[1e-4, 2e-4, 3e-4])
    (row,) = as_rows(parameter_table(Conveyor(acceleration=80.0), z0=[0.0]))
    nothing = conveyor.Attractors([], row, NO_ATTRACTORS)
    labels = conveyor.classify(heights, cycles=100, attractors=nothing)
    assert labels.attractor.tolist() == [-1, -1, -1]
    known, numbers = with_unknown(nothing, labels)
    assert [attractor.state for attractor in known.found] == ["chaos"] and numbers.tolist() == [0, 0, 0]


def test_a_basin_names_attractors_beyond_the_samples():
    """From some millimetres, parts reach motions of three and more cycles that no sample reaches."""
    one = Conveyor(acceleration=37.3634, damping=0.0595)
    basin = conveyor.basin(one, np.linspace(0.5e-3, 4e-3, 10), [-0.3, 0.0, 0.3], cycles=4000)
    assert basin.attractor.min() >= 0
    added = [attractor for attractor in basin.attractors.found if attractor.share == 0.0]
    assert added
    for k, attractor in enumerate(basin.attractors.found):
        assert set(basin.period[basin.attractor == k]) <= {attractor.period}
        assert np.isfinite(attractor.mean_velocity)


def test_motions_that_approach_an_orbit_slowly_are_one_attractor():
    values = {"acceleration": 9.351942795591594, "angle": 0.48281215795047877, "frequency": 242.20536511314174}
    values |= {"stiffness": 439.9583807216725, "damping": 0.39842982519650866, "mass": 0.043934191030875334}
    (one,) = conveyor.attractors(Conveyor(**values, exponent=2.0), samples=32, cycles=4000).found
    assert (one.state, one.period, one.share, one.orbit.stable) == ("first", 1, 1.0, True)
