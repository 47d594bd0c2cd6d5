"""Settings of the floor machine: dimensionless values, the target of another conveyor, and measured files."""

import re

import pytest
import yaml
from project import ROOT, assert_refused, dry_run, load

from conveyor import throw_number
from conveyor_pipeline.config import ConfigError, load_config
from conveyor_pipeline.machine.operating.settings import remedies_for_amplitudes, transit_axis


def test_dimensionless_settings_fit_the_papers_conveyor():
    """On the paper's conveyor, all amplitudes are whole numbers."""
    config = load({})
    assert config["operating"]["acceleration"] == {"start": 19.0, "stop": 155.0, "num": 137}
    assert [config["operating"][key] for key in ("height", "vz0")] == [[0.0, 0.5e-3], [-0.2, 0.2]]
    assert transit_axis(config) == config["operating"]["acceleration"]
    assert (config["clean_drive"]["riding"], config["clean_drive"]["chaos"]) == ([32.0, 44.0], [80.0, 90.0])
    assert config["drive"]["bounds"]["acceleration"] == [10.0, 80.0]
    assert config["drive"]["bounds"]["frequency"] == [40.0, 60.0]
    assert config["drive"]["search"]["longest"] == 2.0
    assert (config["track"]["acceleration"], config["advice"]["changes"]["frequency"]) == (40.0, 1.0)


def test_dimensionless_settings_follow_the_conveyor_and_limits_in_si_units_do_not():
    """Twice the frequency under four times the gravity: heights stay, velocities double, times halve."""
    own, paper = load({"prefix": "mine", "model": {"frequency": 100.0, "gravity": 39.24}}), load({})
    assert own["operating"]["acceleration"] == {"start": 76.0, "stop": 620.0, "num": 137}
    assert (own["operating"]["height"], own["operating"]["vz0"]) == ([0.0, 0.5e-3], [-0.4, 0.4])
    assert (own["drive"]["bounds"]["frequency"], own["drive"]["search"]["longest"]) == ([80.0, 120.0], 1.0)
    assert own["advice"]["changes"]["frequency"] == 2.0
    for section, keys in (("drive", ("impact_speed", "displacement", "velocity")), ("transit", ("length", "longest"))):
        assert [own[section][key] for key in keys] == [paper[section][key] for key in keys]
    assert own["parts"] == paper["parts"]


def test_a_config_with_a_recording_is_not_the_papers():
    recording = {"measured": str(ROOT / "config/examples/accelerometer.csv"), "unit": "g", "mount": 0.1}
    assert not load_config([], {"prefix": "mine", "excitation": recording}).is_paper


@pytest.mark.parametrize("model", [{"angle": 0.4}, {"inclination": 0.3, "gravity": 1.62}, {"frequency": 400.0}])
def test_amplitudes_are_throw_numbers(model):
    config = load({"prefix": "mine", "model": model})
    ends = [config["operating"]["acceleration"][end] for end in ("start", "stop")]
    shape = {key: config["model"][key] for key in ("angle", "gravity", "inclination")}
    assert throw_number(ends, **shape).tolist() == pytest.approx([0.4027, 3.2851], rel=1e-3)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"acceleration": [30.0, 35.0]}, [30.0, 35.0]),
        ({"acceleration": {"num": 15}}, {"start": 19.0, "stop": 155.0, "num": 15}),
        (
            {"acceleration": {"start": 30.0}, "dimensionless": {"acceleration": {"num": 15}}},
            {"start": 30.0, "stop": 155.0, "num": 15},
        ),
        ({"dimensionless": {"acceleration": [0.4239, 1.9074]}}, [20.0, 90.0]),
    ],
)
def test_values_in_si_units_replace_dimensionless_ones(given, expected):
    assert load({"prefix": "mine", "operating": given})["operating"]["acceleration"] == expected


@pytest.mark.parametrize(
    ("overlay", "told"),
    [
        (
            {"operating": {"height": [0.0, 1.0e-3], "dimensionless": {"height": [0.0, 1.0]}}},
            "operating.height is given in SI",
        ),
        ({"transit": {"dimensionless": {"acceleration": [1.0]}}}, "transit.dimensionless is an unknown key"),
        ({"operating": {"acceleration": {"stop": 2.0}}}, "is reversed: start is above stop; give both"),
        ({"operating": {"dimensionless": {"acceleration": {"start": 4.0}}}}, "is reversed: start is above stop"),
        ({"model": {"angle": 0.0}}, "model.angle = 0.0 means that no amplitude can lift a part"),
    ],
)
def test_dimensionless_values_that_cannot_be_used_are_refused(overlay, told):
    with pytest.raises(ConfigError, match=re.escape(told)):
        load({"prefix": "mine", **overlay})


@pytest.mark.parametrize(
    ("operating", "transit", "expected"),
    [
        ([30.0, 40.0], {}, [30.0, 40.0]),
        ([30.0, 40.0], {"acceleration": [50.0]}, [50.0]),
        ({"start": 30.0}, {"acceleration": {"num": 5}}, {"start": 30.0, "stop": 155.0, "num": 5}),
    ],
)
def test_transit_has_the_amplitudes_of_the_shares_unless_it_gives_its_own(operating, transit, expected):
    config = load({"prefix": "mine", "operating": {"acceleration": operating}, "transit": transit})
    assert transit_axis(config) == expected
    key, remedies = f"{'transit' if transit else 'operating'}.acceleration", remedies_for_amplitudes(config, {})
    smaller = f"add a smaller value to `{key}`" if isinstance(expected, list) else f"lower `{key}.start`"
    assert (remedies["key"], remedies["start"]) == (key, smaller)


def test_the_remedy_names_throw_numbers_where_the_config_states_them():
    stated = {"operating": {"dimensionless": {"acceleration": {"start": 0.5, "stop": 2.0, "num": 5}}}}
    remedies = remedies_for_amplitudes(load({"prefix": "mine", **stated}), stated)
    assert remedies["stop"] == "raise `operating.dimensionless.acceleration.stop`"


@pytest.mark.parametrize(
    ("operating", "transit", "told"),
    [
        ([30.0, 40.0], {"num": 5}, "transit.acceleration lacks start, stop, and operating.acceleration is a list"),
        ({"stop": 40.0}, {"start": 50.0}, "transit.acceleration, with what operating.acceleration adds, is reversed"),
    ],
)
def test_amplitudes_of_transit_that_do_not_fit_those_of_the_shares_are_refused(operating, transit, told):
    with pytest.raises(ConfigError, match=re.escape(told)):
        load({"prefix": "mine", "operating": {"acceleration": operating}, "transit": {"acceleration": transit}})


def test_the_default_target_of_another_conveyor_is_its_machine(tmp_path):
    overlay = {"prefix": "mine", "model": {"friction": 0.2}}
    jobs = [
        re.findall(r"^(\w+) +(\d+)$", dry_run(overlay, tmp_path, *target).stdout, re.MULTILINE)
        for target in ((), ("machine",))
    ]
    default, machine = ({name for name, _ in found} - {"all", "machine"} for found in jobs)
    assert (
        default
        == machine
        == {"operating", "transit", "advice", "drift", "track", "operating_chart", "plot", "caption", "total"}
    )


@pytest.mark.parametrize("is_calibrated", [False, True])
def test_transit_and_advice_of_calibrated_parts_depend_on_the_calibration(built, is_calibrated):
    (built.folder / "measured.csv").write_text("acceleration,velocity\n30,0.02\n40,0.05\n50,0.06\n60,0.07\n")
    overlay = {"prefix": "measured", "calibration": {"measurements": "measured.csv"}}
    project = built.under(overlay | {"parts": {"calibrated": is_calibrated}})
    graph = project.snakemake("results/measured/operating/advice.parquet", "--rulegraph", "dot").stdout
    rules = dict(re.findall(r'(\d+)\[label = "(\w+)"', graph))
    edges = {(rules[begin], rules[end]) for begin, end in re.findall(r"(\d+) -> (\d+)", graph)}
    assert ("transit", "advice") in edges
    for source in ("calibration", "calibrated"):
        assert {(source, "transit"), (source, "advice")} <= edges if is_calibrated else source not in rules.values()


def test_braces_in_the_name_of_a_measured_file_or_its_folder_are_refused(project, tmp_path):
    folder = tmp_path / "a{x}"
    folder.mkdir()
    (folder / "mine.csv").write_bytes((ROOT / "config/examples/measured.csv").read_bytes())
    (folder / "mine.yaml").write_text("prefix: mine\ncalibration: {measurements: mine.csv}\n")
    run = project.called("--dry-run", "results/mine/calibration.md", "--configfile", str(folder / "mine.yaml"))
    assert_refused(run, "a{x}/mine.csv' has braces, which Snakemake takes for a wildcard; rename the file or folder")


@pytest.mark.long
def test_columns_with_a_minus_reach_the_overlay_of_the_measured_drive(project):
    """The example's sensor upside down: both files give the same drive."""
    text = (ROOT / "config/examples/accelerometer.csv").read_text()
    lines = [line for line in text.splitlines() if not line.startswith("#")][1:]
    rows = [f"{time},{-float(x):g},{-float(z):g}" for time, x, z in (line.split(",") for line in lines)]
    drives = []
    for prefix, content, columns in (
        ("upright", text, {}),
        ("mirrored", "\n".join(["clock,accel_x,accel_z", *rows]), {"time": "clock", "x": "-accel_x", "z": "-accel_z"}),
    ):
        (project.folder / f"{prefix}.csv").write_text(content)
        excitation = {"measured": f"{prefix}.csv", "unit": "g", "mount": 0.1, "columns": columns}
        own = project.under({"prefix": prefix, "excitation": excitation})
        own.make_in_process(f"results/{prefix}/measured_drive.yaml")
        assert own.planned(f"results/{prefix}/excitation.md") == {"excitation_comparison": 1, "excitation_page": 1}
        drives.append(yaml.safe_load((project.folder / f"results/{prefix}/measured_drive.yaml").read_text())["model"])
    assert drives[0] == drives[1]
    assert drives[0]["frequency"] == pytest.approx(50.0, rel=1e-4)
