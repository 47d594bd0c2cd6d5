"""Errors of the config: early, readable, and with the names of the library."""

import time

import pytest
from project import assert_reported, merged, read_config

from conveyor import Conveyor, Start, ensemble, simulation
from conveyor.methods import fixed_step
from conveyor.parameters import UNITS
from conveyor.solver import model
from conveyor_pipeline.config import canonical, problems
from conveyor_pipeline.config.entries import by_methods, resolve
from conveyor_pipeline.config.schema import schema_at
from conveyor_pipeline.config.tables import kind_of, references, settings_of

CONFIG = read_config()
MINE = {"axes": {"acceleration": {"start": 30, "stop": 40, "num": 3}, "z0": [0.0, "conveyor"]}}

# An overlay, and a part of the expected message.
WRONG = [
    ({"companion": {"maps": ["none"]}}, "companion.maps[0] = 'none' is unknown"),
    ({"sweep": {}}, "sweep is an unknown key; did you mean sweeps?"),
    ({"sweeps": {"mine": {**MINE, "methd": "euler"}}}, "sweeps.mine.methd is an unknown key; did you mean method?"),
    ({"model": {"angle": 12}}, "12° are 0.2094 rad"),
    ({"model": {"z0": "conveyer"}}, "or the word conveyor"),
    ({"model": {"stiffness": "500 N/mm"}}, "'500 N/mm' is not in the unit of the contact law; give it in N/m^1.5"),
    ({"model": {"angle": "120 deg"}}, "model.angle = '120 deg' should be at most 1.5708 (rad)"),
    (
        {"model": {"angle": "25 Grad"}},
        "model.angle = '25 Grad' should be at most 1.5708 (rad), and is 2.5e+10; give rad or deg",
    ),
    (
        {"model": {"acceleration": "0.25 mm", "frequency": "100 Hz"}},
        "at model.frequency = 100 Hz, 0.25 mm zero to peak are 98.7 m/s², and 0.25 mm peak to peak are 49.35 m/s²",
    ),
    (
        {"model": {"acceleration": "0.25 mm", "frequency": "5 kg"}},
        "model.acceleration = '0.25 mm' has a unit of another dimension; give m/s², mm/s² or g",
    ),
    ({"model": {"mass": "0,8 g"}}, "write decimal points, not commas"),
    ({"model": {"mass": "heavy"}}, "model.mass = 'heavy' should be a number, or one with a unit: kg, g or mg"),
    (
        {"sweeps": {"mine": {"axes": {"stiffness": ["5e5 N/m"]}}}},
        "sweeps.mine.axes.stiffness[0] = '5e5 N/m' is not in the unit of the contact law; give it in N/m^1.5",
    ),
    ({"model": {"tension": "pull"}}, "model.tension = 'pull' should be 'allow', 'frictionless' or 'clip'"),
    ({"sweeps": {"mine": {"axes": {"z0": []}}}}, "sweeps.mine.axes.z0 = [] should have at least 1 item"),
    ({"sweeps": {"mine": {"axes": {}}}}, "sweeps.mine.axes = {} is empty"),
    (
        {"sweeps": {"mine": {"axes": {"angle": {"start": 0.1, "stop": 0.2, "num": 0}}}}},
        "sweeps.mine.axes.angle.num = 0 should be at least 1",
    ),
    ({"sweeps": {"mine": {"axes": {"mass": [1.0e-3, -1.0]}}}}, "sweeps.mine.axes.mass[1] = -1.0 should be at least"),
    (
        {"sweeps": {"mine": {"axes": {"z0": {"start": 0.0}}}}},
        "sweeps.mine.axes.z0.stop is missing; give it in m (initial",
    ),
    ({"sweeps": {"mine": {"duration": 1.0}}}, "sweeps.mine.axes is missing; give it (axes of the table: lists of"),
    ({"sweeps": {"mine": {**MINE, "model": {"z0": 1.0e-4}}}}, "sweeps.mine.model.z0 is an axis of this entry too"),
    (
        {"sweeps": {"amplitudes": {"axes": {"damping": [0.1, 0.3]}}}},
        "sweeps.amplitudes.axes.damping is no axis of this entry of the defaults",
    ),
    ({"sweeps": {"mine": {**MINE, "duration": 0}}}, "sweeps.mine.duration = 0 should be more than 0 (s)"),
    ({"sweeps": {"mine": {**MINE, "needs": "speed"}}}, "sweeps.mine.needs = 'speed' should be 'feeding' or 'vertical'"),
    ({"sweeps": {"my sweep": MINE}}, "sweeps has the unknown name 'my sweep'; give a name of letters"),
    (
        {"sweeps": {"mine": {**MINE, "method": "euler", "step": 3.0e-7}}},
        "sweeps.mine.step = 3e-07 s does not divide its duration of 1 s; take 3.0000003e-07, or another duration",
    ),
    ({"estimates": {"phase": {"last": 1}}}, "estimates.phase.last = 1 should be less than 1 (of the duration)"),
    (
        {"estimates": {"phase": {"last": 25}}},
        "estimates.phase.last = 25 should be less than 1 (of the duration); this is a share: write 25 % or 0.25",
    ),
    (
        {"figures": {"fig03": {"tables": {"euler": "sweeps/none"}}}},
        "figures.fig03.tables.euler = 'sweeps/none'",
    ),
    ({"sweeps": {"amplitudes": {"needs": "vertical"}}}, "figures.fig03 needs feeding, but sweeps/amplitudes"),
    (
        {"figures": {"fig99": {**CONFIG["figures"]["fig03"]}}},
        "fig99 has no files scripts/conveyor_pipeline/FLOOR/figures/fig99.py",
    ),
    ({"prefix": "a\n"}, "prefix = 'a\\n' should be a folder name of at most 64"),
    # silently wrong results, if accepted
    ({"estimates": {"height": {"model": {"z0": "conveyor"}}}}, "estimates.height.perturb = 'z0' has no effect"),
    ({"estimates": {"phase": {"epsilon": 1.0e-300}}}, "estimates.phase.epsilon = 1e-300 should be at least 1e-15"),
    (
        {"estimates": {"height": {"epsilon": 1.0e-15, "axes": {"z0": [9.0]}}}},
        "estimates.height.epsilon = 1e-15 is lost in the rounding of z0",
    ),
    (
        {"sweeps": {"heights": {"step": 0.1, "duration": 0.02}}},
        "sweeps.heights.step = 0.1 s is too long for 50 Hz",
    ),
    ({"sweeps": {"heights": {"step": 1.0e-12}}}, "sweeps.heights.step = 1e-12 s makes 1e+12 steps"),
    ({"solver": {"step": 0.1}}, "solver.step (of sweeps.amplitudes) = 0.1 s is too long for 50 Hz"),
    ({"dimensions": {"portrait_euler": {"step": 3.0e-6}}}, "dimensions.portrait_euler.step = 3e-06"),
    ({"critical": {"edge": {"axes": {"z0": [0.0]}}}}, "critical.edge.axes.z0 is the scanned parameter"),
    (
        {"figures": {"fig09": {"marks": {"critical_hight": 1.0}}}},
        "figures.fig09.marks.critical_hight is an unknown key; did you mean critical_height?",
    ),
    # failures in a job, if accepted
    ({"orbits": {"limits": [20, 40]}}, "orbits.limits = [20.0, 40.0] m/s² must hold the amplitude of orbits.seeds[1]"),
    (
        {"dimensions": {"portrait": {"method": "euler"}}},
        "dimensions.portrait.estimator = 'box' follows the settled",
    ),
    (
        {"critical": {"edge": {"scan": [0.0, 2.0e-4, 1.0e-4]}}},
        "critical.edge.scan = [0.0, 0.0002, 0.0001] is not",
    ),
    ({"critical": {"edge": {"scan": {"num": 1}}}}, "critical.edge.scan.num = 1 should be at least 2"),
    (
        {"critical": {"edge": {"scan": [0.0, "conveyor"]}}},
        "critical.edge.scan[1] = 'conveyor' should be a number",
    ),
    (
        {"signals": {"states": {"times": {"stop": 2.0}}}},
        "signals.states.times.stop = 2.0 s is beyond",
    ),
    (
        {"regressions": {"height": {"bounds": {"B": [-35.0, 0.0]}}}},
        "regressions.height.bounds.B from -35.0 to 0.0 m/s² has a pole of Eq. 13",
    ),
    (
        {"regressions": {"height": {"critical": "edgee"}}},
        "regressions.height.critical = 'edgee' is unknown; did you mean edge?",
    ),
    (
        {"sweeps": {"heights": {"axes": {"acceleration": [29.0, 29]}}}},
        "acceleration = [29.0, 29] has 29.0 twice",
    ),
    # two entries that make the same table
    (
        {"sweeps": {"mine": {**MINE, "methods": ["event", "euler"]}, "mine_euler": MINE}},
        "sweeps.mine_euler is the name of two tables",
    ),
    # settings that exclude each other
    ({"sweeps": {"amplitudes": {"method": "euler"}}}, "sweeps.amplitudes has both method and methods"),
    ({"sweeps": {"mine": {**MINE, "step": 1.0e-6}}}, "sweeps.mine.step is not used by the method event"),
    # folders of the default results
    ({"prefix": "Logs"}, "prefix = 'Logs' is a folder of"),
    # tables and settings that the default config does not have there
    ({"figures": {"fig03": {"settings": {"acceleration": 40.0}}}}, "figures.fig03.settings.acceleration is an unknown"),
    (
        {"sweeps": {"mine": {"axes": {"friction": [0.1, 0.3]}, "model": {"static_friction": 0.2}}}},
        "sweeps.mine has static_friction = 0.2 below friction = 0.3",
    ),
    (
        {"orbits": {"model": {"static_friction": 0.1}}},
        "orbits.model has static_friction = 0.1 below friction = 0.15; give a larger static_friction, or leave it out",
    ),
    (
        {"prefix": "mine", "model": {"exponent": 1.0}},
        "model.exponent = 1.0 changes the unit of model.stiffness; state model.stiffness in N/m too",
    ),
    (
        {"prefix": "mine", "model": {"exponent": 2}},
        "model.exponent = 2.0 changes the unit of model.stiffness; state model.stiffness in N/m^2 too",
    ),
    ({"model": {"inclination": 3.0}}, "model.inclination = 3.0 should be at most 1.4 (rad); angles are in radians"),
    # values that could crash the check, or let it run without end
    ({"figures": {"fig03": {"tables": {"euler": "model/acceleration"}}}}, "euler = 'model/acceleration' is unknown"),
    ({1: {}}, "config has the key 1, which is not text"),
    ({"model": {0: None}}, "model has the key 0, which is not text; write decimal points, not commas"),
    ({"sweeps": {2024: MINE}}, "sweeps has the key 2024, which is not text; put it in quotes"),
    ({"model": None}, "model is empty; give keys below it, or delete it"),
    ({"prefix": 1}, "prefix = 1 is a number, not text; put it in quotes"),
    (
        {"sweeps": {"heights": {"axes": {"z0": {"num": 1.0e12}}}}},
        "sweeps.heights.axes.z0.num = 1000000000000 should be at most 1e+06",
    ),
    (
        {"critical": {"edge": {"axes": {"acceleration": {"num": 1.0e6}}}}},
        "points or rows; at most 10,000,000",
    ),
    (
        {"sweeps": {"map_height": {"axes": {"psi0": {"num": 1.0e6}, "z0": {"num": 1.0e6}}}}},
        "sweeps.map_height.axes makes 1,000,000,000,000 rows in 5,000,000 jobs; at most 1,000 are allowed",
    ),
]


@pytest.mark.parametrize(("overlay", "message"), WRONG, ids=[message[:40] for _, message in WRONG])
def test_an_error_names_key_and_remedy(overlay, message):
    assert_reported(overlay, message)


def test_a_fault_of_the_model_is_reported_once_for_all_entries_that_inherit_it():
    lines = problems(merged(CONFIG, {"prefix": "mine", "model": {"static_friction": 0.1}}))
    assert [line.partition(" = ")[0] for line in lines] == ["model has static_friction"]


def test_configs_are_valid():
    assert problems(CONFIG) == []
    assert problems(merged(CONFIG, read_config("reduced"))) == []
    assert problems(merged(CONFIG, {"sweeps": {"mine": MINE}})) == []


@pytest.mark.parametrize(
    "overlay",
    [
        {"sweeps": {"mine": {**MINE, "methods": ["event", "euler"], "step": 1.0e-6}}},
        {"sweeps": {"mine": {**MINE, "methods": ["euler"]}, "mine_event": MINE}},
        {"sweeps": {"mine": MINE, "mine_euler": MINE}},
        {"sweeps": {"mine": MINE, "mine_tighter": MINE}},
        {"critical": {"edge_euler": {"step": 1.0e-6}}},
        {"figures": {"fig03": {"tables": {"euler": "sweeps/amplitudes"}, "marks": {"critical_acceleration": 45}}}},
        {"model": {"static_friction": 0.15}},
        {"prefix": "mine", "model": {"static_friction": 0.2}},
        {"prefix": "mine", "model": {"friction": 0.0, "static_friction": 0.1}},
        {"prefix": "mine", "model": {"exponent": 1.0, "stiffness": "35 N/mm"}},
        {"estimates": {"phase": {"last": "25 %"}}},
        {"figures": {"fig03": {"section": r"$\dot{x}_p$ über $\hat{a}$ {braces} {}"}}},
        {"certificates": {"doublings": 4.0}, "solver": {"settling": 2.0e4}},
        {"sweeps": {"amplitudes": {"axes": {"acceleration": {"start": 20, "num": 20.0}}}}},
        {"prefix": "a-b_C1"},
        {"sweeps": {"one": {"axes": {"z0": ["conveyor"]}}}},
    ],
    ids=str,
)
def test_a_valid_overlay_has_no_errors(overlay):
    assert problems(merged(CONFIG, overlay)) == []


def test_a_stiffness_may_keep_its_number_in_another_unit():
    overlay = {"prefix": "mine", "model": {"exponent": 1.0, "stiffness": CONFIG["model"]["stiffness"]}}
    assert problems(merged(CONFIG, overlay), stated=overlay) == []


def test_methods_make_a_table_each():
    portrait = {"axes": {"acceleration": [40.0]}, "estimator": "paper", "methods": ["event", "euler"]}
    config = merged(CONFIG, {"dimensions": {"mine": portrait}})
    assert problems(config) == []
    assert by_methods(config)["dimensions"]["mine_euler"]["method"] == "euler"


def test_a_step_of_the_default_config_may_be_left_unused():
    """An overlay cannot remove a key."""
    default = merged(CONFIG, {"sweeps": {"mine": {**MINE, "method": "euler", "step": 1.0e-6}}})
    assert problems(merged(default, {"sweeps": {"mine": {"method": "event"}}}), default) == []


@pytest.mark.parametrize(
    "overlay",
    [
        {"sweeps": {"mine": {"axes": {"z0": [1.0e-4] * 300_000}}}},
        {"sweeps": {"mine": {"axes": {"z0": ["x"] * 300_000}}}},
        {"certificates": {"acceleration": ["x"] * 300_000}},
    ],
    ids=["equal", "words", "proofs"],
)
def test_a_long_list_is_rejected_at_once(overlay):
    begin = time.process_time()
    (line,) = problems(merged(CONFIG, overlay))
    assert time.process_time() - begin < 1.0
    assert len(line) < 300


def test_the_config_uses_the_names_of_the_library():
    for section, key, words in (("solver", "method", simulation.METHODS), ("model", "tension", model.TENSION_MODES)):
        assert tuple(schema_at([section, key])["enum"]) == words
    assert tuple(schema_at(["sweeps", "mine", "needs"])["enum"]) == ensemble.NEEDS
    assert ("event", *fixed_step.METHODS) == simulation.METHODS


def test_config_has_the_defaults_of_the_library():
    values = dict(CONFIG["model"])
    assert Start(values.pop("z0"), values.pop("vz0")) == Start()
    assert Conveyor(**values) == Conveyor()
    assert CONFIG["solver"]["tolerance"] == simulation.DEFAULT_TOLERANCE
    assert CONFIG["solver"]["step"] == simulation.DEFAULT_STEP


def test_an_entry_depends_on_what_it_uses_only():
    settings = resolve(merged(CONFIG, {"sweeps": {"mine": {**MINE, "model": {"damping": 0.2}}}}), "sweeps", "mine")
    assert settings["model"].keys() == UNITS.keys() - {"acceleration", "z0", "static_friction"}
    assert settings["model"]["damping"] == 0.2
    assert settings["tolerance"] == CONFIG["solver"]["tolerance"]
    assert "step" not in settings
    euler = resolve(merged(CONFIG, {"sweeps": {"mine": {**MINE, "method": "euler"}}}), "sweeps", "mine")
    assert euler["step"] == CONFIG["solver"]["step"]
    assert "tolerance" not in euler


def test_a_new_table_depends_on_the_model_and_on_the_section_of_its_name():
    model = {name: value for name, value in CONFIG["model"].items() if name != "acceleration"}
    assert settings_of(CONFIG, "operating/counted") == {"model": model}
    assert settings_of({**CONFIG, "counted": {"runs": 3}}, "operating/counted") == {"runs": 3, "model": model}
    assert kind_of("operating/counted") == "counted"


def test_a_new_table_is_known_if_the_default_config_reads_it():
    figures = {"fig01": {"tables": {"counted": "operating/counted"}}}
    changed = merged(CONFIG, {"figures": figures})
    (line,) = problems(changed, merged(CONFIG, {"figures": {"fig01": {"tables": {"counted": "operating/shares"}}}}))
    assert line.startswith("figures.fig01.tables.counted = 'operating/counted' is unknown; did you mean")
    assert problems(changed, changed) == []


ALONG = {"friction": 0.2, "phase_shift": 0.4, "static_friction": 0.3}
NORMAL = ("orbits/branches", "orbits/certificates", "attractors/strobes", "lyapunov/spectrum")


def test_tables_of_the_normal_motion_do_not_depend_on_the_motion_along_the_track():
    mine = {name: {"axes": {"acceleration": [30.0]}, "needs": name} for name in ("vertical", "feeding")}
    before, after, inclined = (
        by_methods(canonical(merged(CONFIG, {"sweeps": mine, "model": change})))
        for change in ({}, ALONG, {"inclination": 0.1})
    )
    tables = [reference for reference in references(before) if settings_of(before, reference) is not None]
    same = {reference for reference in tables if settings_of(before, reference) == settings_of(after, reference)}
    assert {"sweeps/vertical", "regressions/height", *NORMAL} <= same
    assert {
        reference for reference in tables if reference.split("/")[0] in ("critical", "dimensions", "impacts")
    } <= same
    assert "sweeps/feeding" not in same
    assert "operating/shares" not in same
    for reference in ("sweeps/vertical", *NORMAL):
        assert settings_of(before, reference) != settings_of(inclined, reference)


def test_an_axis_along_the_track_keeps_the_parameters_along_it():
    entry = {"axes": {"static_friction": [0.05]}, "model": {"friction": 0.02}, "needs": "vertical"}
    assert resolve(merged(CONFIG, {"sweeps": {"mine": entry}}), "sweeps", "mine")["model"]["friction"] == 0.02
