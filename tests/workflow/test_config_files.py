"""Faults of config files that are found before Snakemake merges them, and how they are reported."""

import os
import resource
import subprocess
import sys

import pandas as pd
import pytest
import yaml
from project import CONFIG_FILES, ROOT, Project, copy_project, merged, read_config

from workflow.config import ConfigError, canonical, load_config, problems
from workflow.config.entries import METHOD_SECTIONS, by_methods, resolve
from workflow.config.files import DEFAULT_FILES, parse_texts, read

FAULTS = [
    ("model: {mass: 0.1}\nsolver: {}\nmodel: {angle: 0.1}\n", ":3: model is already set in line 1"),
    ("sweeps:\n  mine:\n    axes: {z0: [0.0], z0: [1.0]}\n", ":3: sweeps.mine.axes.z0 is already set in line 3"),
    ("model:\n  stiffness: 050\n", ":2: model.stiffness = 050 is read as 40, an octal number"),
    ("model: {stiffness: 1:30}\n", ":1: model.stiffness = 1:30 is read as 90, with base 60"),
    ("sweeps:\n  mine:\n    axes: {z0: [0.0, -1:30.5]}\n", ":3: sweeps.mine.axes.z0[1] = -1:30.5 is read as"),
    ("model: &m {mass: *m}\n", ":1: model.mass contains itself through an anchor"),
    ("model: {mass: 0.1\n", ":2: is not YAML: "),
    (
        "model:\n\tmass: 0.1\n",
        ":2: is not YAML: found character that cannot start any token; write spaces in place of tabs",
    ),
    ("- 1\n", ": has no keys with values"),
    ("", ": has no keys with values"),
    (b"model:\n  # \xe4\n", ":2: is not UTF-8 text"),
    (None, ": No such file or directory"),
    ("sweeps: [" + "1," * 300_000 + "]", ":1: has more than 12,000 values"),
    ("[" * 100_000, ":1: has more than 50 nested levels"),
    ("\n".join(" " * level + "a:" for level in range(3000)), ":51: has more than 50 nested levels"),
    ("- " * 50_000 + "1", ":1: has more than 50 nested levels"),
    (
        "a0: &a0 [1, 1]\n" + "".join(f"a{i}: &a{i} [*a{i - 1}, *a{i - 1}]\n" for i in range(1, 40)),
        ":13: has more than 12,000 values",
    ),
    ("model: {mass: " + "1" * 5000 + "}", ":1: model.mass = 1111"),
    ("model: {mass: 2001-13-45}", ":1: model.mass = 2001-13-45 cannot be read as timestamp; write a number"),
    ("model: {mass: !!int heavy}", ":1: model.mass = heavy cannot be read as int"),
    ("model: {mass: !!int ''}", ":1: model.mass =  cannot be read as int"),
    ("model: {mass: !!bool maybe}", ":1: model.mass = maybe cannot be read as bool"),
    ("model: {mass: !!timestamp now}", ":1: model.mass = now cannot be read as timestamp"),
    ("model: {mass: !gram 3}", ":1: model.mass = 3 cannot be read as !gram"),
    ("model: {!!bool maybe: 3}", ":1: model.maybe = maybe cannot be read as bool"),
    ("prefix: " + "a" * 2_000_000, ":1: has more than 1,000,000 characters"),
]


@pytest.mark.parametrize(("text", "message"), FAULTS, ids=[message for _, message in FAULTS])
def test_a_fault_names_file_line_and_key(tmp_path, text, message):
    file = tmp_path / "mine.yaml"
    if text is not None:
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
    faults, _ = read(file)
    assert faults[0].startswith(f"{file}{message}"), faults


def test_a_directory_is_not_a_config(tmp_path):
    assert read(tmp_path) == (
        [f"{tmp_path}: Is a directory; name a config file (put targets before --configfile)"],
        None,
    )


def test_a_pipe_is_refused_because_snakemake_cannot_read_it_again(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    faults, _ = read(tmp_path / "pipe")
    assert faults == [f"{tmp_path}/pipe: is no regular file; save the config in one, and name that file"]


def test_merge_keys_are_read(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("a: &a {b: 1}\nc: {<<: *a, d: 2}\n")
    assert read(file) == ([], {"a": {"b": 1}, "c": {"b": 1, "d": 2}})


def test_only_octal_numbers_are_reported(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("a: {b: 010}\nd: '050'\ne: 0\nf: 0.5\n")
    assert read(file)[0] == [f"{file}:1: a.b = 010 is read as 8, an octal number; write it without the 0"]


def test_json_is_a_config(tmp_path):
    file = tmp_path / "mine.json"
    file.write_text('{\n\t"model": {"mass": 0.001, "z0": 0},\n\t"sweeps": {}\n}\n')
    assert read(file) == ([], {"model": {"mass": 0.001, "z0": 0}, "sweeps": {}})


@pytest.mark.parametrize("file", [*CONFIG_FILES, "reduced"])
def test_files_of_the_project_are_valid(file):
    assert read(ROOT / f"config/{file}.yaml") == ([], read_config(file))


def test_keys_are_in_the_order_of_the_first_file(tmp_path):
    """Snakemake begins with the overlay, adds the config of the Snakefile, and merges the overlay again."""
    overlay = {"sweeps": {"heights": {"axes": {"z0": {"num": 41}}}}, "figures": {"fig22": {"section": "4.1"}}}
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(overlay))
    as_snakemake_merges = merged(overlay, read_config(), overlay)
    assert list(as_snakemake_merges["sweeps"]["heights"]["axes"]) == ["z0", "acceleration"]
    loaded = load_config(DEFAULT_FILES, [file], as_snakemake_merges)
    assert list(loaded.config["sweeps"]["heights"]["axes"]) == ["acceleration", "z0"]
    assert loaded.config["sweeps"]["heights"]["axes"]["z0"]["num"] == 41
    assert list(loaded.config["figures"]) == list(read_config()["figures"])


def test_a_config_is_loaded_from_any_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    loaded = load_config(DEFAULT_FILES, [], {})
    assert loaded.paper == read_config()
    assert not loaded.own_conveyor
    assert "amplitudes_euler" in loaded.config["sweeps"]


def test_a_config_without_files_is_the_overlay_of_a_module(tmp_path):
    """Another workflow passes its config directly, which has the effect of a file with the same content."""
    overlay = {"prefix": "mine", "model": {"frequency": 100, "mass": 1.0e-3}, "sweeps": {"one": {"axes": {"z0": [0]}}}}
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(overlay))
    loaded = load_config(DEFAULT_FILES, [], overlay)
    assert repr(loaded) == repr(load_config(DEFAULT_FILES, [file], overlay))
    assert loaded.own_conveyor
    assert "fig04" not in loaded.config["figures"]
    assert loaded.config["sweeps"]["one"] == {"axes": {"z0": [0.0]}}


def test_an_error_has_six_lines():
    overlay = {"sharing": {"core_hours": 1.0e-6}}
    with pytest.raises(ConfigError, match="The config cannot be used") as error:
        load_config(DEFAULT_FILES, [], overlay)
    assert len(str(error.value).splitlines()) <= 6


def test_the_config_of_the_paper_is_in_canonical_form():
    """Otherwise tables would change, because rules pass keys in this order and numbers of these types."""
    config = plain(read_config())
    found = canonical(config)
    assert found == config
    for section in config.keys() - set(METHOD_SECTIONS):
        assert written(found[section]) == written(config[section])
    found, config = by_methods(found), by_methods(config)
    for section in METHOD_SECTIONS:
        for name in config[section]:
            assert written(resolve(found, section, name)) == written(resolve(config, section, name))


def written(value) -> str:
    return yaml.safe_dump(value, sort_keys=False)


def plain(value):
    """A copy of the value at each place where YAML has an anchor."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    return [plain(item) for item in value] if isinstance(value, list) else value


@pytest.fixture(scope="module")
def project(tmp_path_factory) -> Project:
    """A copy of the project without results."""
    return Project(copy_project(tmp_path_factory.mktemp("refused")))


def seconds_of_children() -> float:
    """Processor time of child processes (s), which does not depend on the load of the machine."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


REFUSED = [
    ({"prefix": "a\nb"}, "prefix = 'a\\nb' should be a folder name"),
    ({1: {}}, "config has a key that YAML reads as 1"),
    ({"orbits": {"seeds": [{"acceleration": -1.0, "z0": 0.0}] * 200}}, "195 more"),
]


@pytest.mark.parametrize(("overlay", "message"), REFUSED, ids=[message for _, message in REFUSED])
def test_snakemake_refuses_in_ten_lines(project, overlay, message):
    run = project.under(overlay).snakemake("--dry-run", "figures/fig22.pdf")
    assert_refused(run, message)
    assert "Building DAG" not in run.stdout


def test_snakemake_refuses_in_three_seconds(project):
    begin = seconds_of_children()
    new_process = {"LC_ALL": "C.UTF-8"}
    run = Project(project.folder, REFUSED[-1][0], new_process).snakemake("--dry-run", "figures/fig22.pdf")
    assert seconds_of_children() - begin < 3.0
    assert_refused(run, REFUSED[-1][1])


def assert_refused(run, message: str) -> None:
    assert run.returncode != 0
    assert message in run.stdout
    assert len(run.stdout.splitlines()) <= 10


def test_snakemake_names_file_and_line_of_an_overlay(project, tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("model: {mass: 0.1}\nmodel: {mass: 0.2}\n")
    run = project.called("--dry-run", "figures/fig22.pdf", "--configfile", str(file))
    assert_refused(run, "mine.yaml:2: model is already set in line 1")


def test_values_of_the_command_line_are_checked(project):
    run = project.called("--dry-run", "figures/fig22.pdf", "--config", "model={mass: -3.0}", "prefix=[x]")
    assert "Traceback" not in run.stdout
    assert_refused(run, "model.mass = -3.0 should be at least 1e-12 (kg)")
    assert "prefix = ['x'] should be a valid string" in run.stdout


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ({"model": "{mass: 0.1"}, "model = '{mass: 0.1' should be a valid mapping"),
        ({"model": {"mass": "050"}}, "model.mass = '050' is text to YAML"),
        ({"model": {"mass": "-3.0"}}, "model.mass = -3.0 should be at least 1e-12 (kg)"),
    ],
)
def test_texts_in_values_of_the_command_line_are_read_as_yaml_does(value, message):
    assert message in problems(merged(read_config(), parse_texts(value)))[0]


def test_nested_values_of_the_command_line_are_an_overlay(project, tmp_path):
    """They are merged over the overlay files, and numbers are numbers, although Snakemake reads them as texts."""
    overlay = {"prefix": "nested", "sweeps": {"amplitudes": {"model": {"mass": 0.002}, "duration": 0.02}}}
    under = Project(project.folder, overlay | {"model": {"damping": 0.3}})
    values = ("model={damping: 0.2}", "sweeps={amplitudes: {model: {friction: 0.3}, axes: {z0: [0, 1.0e-4]}}}")
    target = "results/nested/sweeps/amplitudes.parquet"
    under.make_in_process(target, "--config", *values)
    settings = pd.read_parquet(project.folder / target).attrs
    assert settings["model"] == settings["model"] | {"damping": 0.2, "mass": 0.002, "friction": 0.3}
    assert settings["axes"]["z0"] == [0.0, 1.0e-4]


def test_a_file_that_anchors_make_large_is_rejected(project, tmp_path):
    """Before Snakemake reads it, which would take all memory."""
    file = tmp_path / "large.yaml"
    file.write_text("a0: &a0 [1, 1]\n" + "".join(f"a{i}: &a{i} [*a{i - 1}, *a{i - 1}]\n" for i in range(1, 60)))
    run = project.called("--dry-run", "figures/fig22.pdf", "--configfile", str(file))
    assert "Traceback" not in run.stdout
    assert_refused(run, "has more than 12,000 values")


def test_a_run_of_another_conveyor_says_first_what_was_scaled_and_dropped(project, tmp_path):
    """Half the period, a quarter of the height: the velocities are half as large."""
    file = tmp_path / "fast.yaml"
    file.write_text("prefix: fast\nmodel: {frequency: 100.0}\n")
    run = project.called("--dry-run", "figures/fast/operating.pdf", "--configfile", str(file))
    (notice,) = [line for line in run.stdout.splitlines() if line.startswith("fast is a conveyor other than")]
    assert "heights × 0.25, velocities × 0.5, times × 0.5" in notice
    assert "Dropped: the paper's claims" in notice and "differences of parts" in notice
    assert run.stdout.index(notice) < run.stdout.index("Building DAG")


def test_overlays_can_be_checked_without_snakemake(tmp_path):
    file, check = tmp_path / "mine.yaml", [sys.executable, "-m", "workflow.config"]
    file.write_text("prefix: mine\nmodel: {damping: 0.2\n")
    run = subprocess.run([*check, str(file)], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 1 and f"{file}:3: is not YAML: " in run.stderr
    file.write_text("model: {damping: 0.2}")
    run = subprocess.run([*check, str(file)], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 0 and "valid" in run.stdout
