"""Errors of the config: named, early, readable; the schema agrees with the library."""

import resource

import pytest
import yaml

from conveyor import Conveyor, Start, fixed_step, model, simulation, sweep
from project import merged, read_config
from workflow.configuration import SCHEMA, problems, resolve

CONFIG = read_config()
DEFINITIONS = yaml.safe_load(SCHEMA.read_text())["$defs"]
MINE = {"axes": {"acceleration": {"start": 30, "stop": 40, "num": 3}, "z0": [0.0, "conveyor"]}}

# An overlay, and words of the message that it must cause.
WRONG = [
    ({"sweep": {}}, "sweep is an unknown key; did you mean sweeps?"),
    ({"sweeps": {"mine": {**MINE, "methd": "euler"}}}, "sweeps.mine.methd is an unknown key; did you mean method?"),
    ({"model": {"mass": -0.1}}, "model.mass = -0.1 is outside [1e-12, 1e+06] kg"),
    ({"model": {"angle": 12}}, "12° are 0.2094 rad"),
    ({"model": {"z0": "conveyer"}}, "or the word conveyor"),
    ({"model": {"stiffness": "5e5"}}, "model.stiffness = '5e5' is text to YAML"),
    ({"model": {"damping": None}}, "model.damping = None is not a number (N s/m)"),
    ({"model": {"tension": "pull"}}, "model.tension = 'pull' is not one of allow, frictionless, clip"),
    ({"sweeps": {"mine": {"axes": {"z0": []}}}}, "sweeps.mine.axes.z0 is empty"),
    ({"sweeps": {"mine": {"axes": {}}}}, "sweeps.mine.axes is empty"),
    (
        {"sweeps": {"mine": {"axes": {"angle": {"start": 0.1, "stop": 0.2, "num": 0}}}}},
        "sweeps.mine.axes.angle.num = 0 makes an empty axis",
    ),
    (
        {"sweeps": {"mine": {"axes": {"angle": {"start": 0.1, "stop": 12, "num": 2}}}}},
        "axes.angle.stop = 12 is outside",
    ),
    ({"sweeps": {"mine": {"axes": {"mass": [1.0e-3, -1.0]}}}}, "sweeps.mine.axes.mass[1] = -1.0 is outside"),
    ({"sweeps": {"mine": {"axes": {"accel": [30.0]}}}}, "sweeps.mine.axes.accel is an unknown key"),
    ({"sweeps": {"mine": {"axes": {"z0": {"start": 0.0}}}}}, "sweeps.mine.axes.z0 lacks stop, num"),
    ({"sweeps": {"mine": {"duration": 1.0}}}, "sweeps.mine lacks axes"),
    ({"sweeps": {"mine": {**MINE, "model": {"z0": 1.0e-4}}}}, "sweeps.mine.model.z0 is an axis of this entry too"),
    ({"sweeps": {"mine": {**MINE, "duration": 0}}}, "sweeps.mine.duration = 0 is outside (0, 1e+06] s"),
    ({"sweeps": {"mine": {**MINE, "duration": float("nan")}}}, "sweeps.mine.duration = nan is not a finite number"),
    ({"sweeps": {"mine": {**MINE, "needs": "speed"}}}, "sweeps.mine.needs = 'speed' is not one of feeding, vertical"),
    ({"sweeps": {"my sweep": MINE}}, "sweeps = 'my sweep' is not a name of letters"),
    (
        {"sweeps": {"mine": {**MINE, "method": "euler", "step": 3.0e-7}}},
        "sweeps.mine.step = 3e-07 s does not divide its duration of 1.0 s; take 3.0000003",
    ),
    (
        {"sweeps": {"mine": {**MINE, "method": "euler", "step": 5.0e-3, "duration": 1.0e-3}}},
        "sweeps.mine.step = 0.005 s",
    ),
    ({"estimates": {"phase": {"last": 1}}}, "estimates.phase.last = 1 is outside (0, 1) of the duration"),
    ({"estimates": {"phase": {"epsilon": 0.0}}}, "estimates.phase.epsilon = 0.0 is outside (0, 1]"),
    (
        {"figures": {"fig03": {"tables": {"euler": "sweeps/none"}}}},
        "figures.fig03.tables.euler = 'sweeps/none'",
    ),
    ({"sweeps": {"amplitudes": {"needs": "vertical"}}}, "figures.fig03 needs feeding, but sweeps/amplitudes"),
    ({"figures": {"fig99": {**CONFIG["figures"]["fig03"]}}}, "figures.fig99 has no scripts/plots/fig99.py"),
    ({"companion": {"maps": ["none"]}}, "companion.maps[0] = 'none' is no entry of sweeps"),
    ({"companion": {"opening": "third"}}, "companion.opening = 'third' is not one of first, second, chaos"),
    ({"companion": {"presets": {"mine": {"mas": 1.0}}}}, "companion.presets.mine.mas is an unknown key"),
    ({"prefix": "a/b"}, "prefix = 'a/b' is not a folder name"),
]


@pytest.mark.parametrize(("overlay", "message"), WRONG, ids=[message[:40] for _, message in WRONG])
def test_an_error_names_key_and_remedy(overlay, message):
    lines = problems(merged(CONFIG, overlay))
    assert any(message in line for line in lines), lines


def test_configs_are_right():
    assert problems(CONFIG) == []
    assert problems(merged(CONFIG, read_config("config/reduced.yaml"))) == []
    assert problems(merged(CONFIG, {"sweeps": {"mine": MINE}})) == []


def seconds_of_children() -> float:
    """Processor time that child processes have taken: a busy machine does not add to it."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


@pytest.mark.parametrize("number", [0, 2, 8, 10])
def test_snakemake_stops_within_three_seconds(built, number):
    overlay, message = WRONG[number]
    begin = seconds_of_children()
    run = built.under(overlay).snakemake("figures/fig22.pdf")
    assert seconds_of_children() - begin < 3.0
    assert run.returncode != 0
    assert message in run.stdout
    assert "Building DAG" not in run.stdout


def test_schema_has_the_ranges_and_words_of_the_library():
    for name, (low, high) in model.RANGES.items():
        definition = DEFINITIONS[name]
        assert (definition["minimum"], definition["maximum"], definition["unit"]) == (low, high, model.UNITS[name])
    assert set(DEFINITIONS["model"]["properties"]) == set(DEFINITIONS["axes"]["properties"]) == set(model.PARAMETERS)
    assert tuple(DEFINITIONS["tension"]["enum"]) == model.TENSION_MODES
    assert tuple(DEFINITIONS["method"]["enum"]) == simulation.METHODS == ("event", *fixed_step.METHODS)
    assert tuple(DEFINITIONS["needs"]["enum"]) == sweep.NEEDS


def test_config_has_the_defaults_of_the_library():
    values = dict(CONFIG["model"])
    assert Start(values.pop("z0"), values.pop("vz0")) == Start()
    assert Conveyor(**values) == Conveyor()
    assert CONFIG["solver"]["tolerance"] == simulation.DEFAULT_TOLERANCE
    assert CONFIG["solver"]["step"] == simulation.DEFAULT_STEP


def test_an_entry_depends_on_what_it_uses_only():
    settings = resolve(merged(CONFIG, {"sweeps": {"mine": {**MINE, "model": {"damping": 0.2}}}}), "sweeps", "mine")
    assert settings["model"].keys() == model.UNITS.keys() - {"acceleration", "z0"}
    assert settings["model"]["damping"] == 0.2
    assert settings["tolerance"] == CONFIG["solver"]["tolerance"]
    assert "step" not in settings
    euler = resolve(merged(CONFIG, {"sweeps": {"mine": {**MINE, "method": "euler"}}}), "sweeps", "mine")
    assert euler["step"] == CONFIG["solver"]["step"]
    assert "tolerance" not in euler
