"""Faults of config files that are found before Snakemake merges them, and how they are reported."""

import os
import re
import resource
import subprocess
import sys

import pandas as pd
import pytest
import yaml
from project import (
    CONFIG_FILES,
    IN_PROCESS_OPTIONS,
    ROOT,
    Project,
    assert_refused,
    call_snakemake,
    config_file,
    copy_project,
    merged,
    read_config,
)

from conveyor_pipeline.config import ConfigError, load_config
from conveyor_pipeline.config.files import read

FAULTS = [
    (
        "model: {mass: 0.1}\nsolver: {}\nmodel: {angle: 0.1}\n",
        ':3: is not valid YAML: found duplicate key "model"; merge both',
    ),
    ("sweeps:\n  mine:\n    axes: {z0: [0.0], z0: [1.0]}\n", ':3: is not valid YAML: found duplicate key "z0"'),
    ("model: {mass: 0.1\n", ":2: is not valid YAML: did not find expected"),
    ("model:\n\tmass: 0.1\n", ":2: is not valid YAML: found character that cannot start any token; write spaces"),
    ("model: {mass: !gram 3}", ":1: is not valid YAML: could not determine a constructor for the tag '!gram'"),
    ("model: {mass: !!bool maybe}", ": is not valid YAML: "),
    ("model: {mass: 2001-13-45}", ": is not valid YAML: month must be in 1..12"),
    ("- 1\n", ": has no keys with values"),
    ("", ": has no keys with values"),
    (b"model:\n  # \xe4\n", ": is not valid YAML: 'utf-8' codec can't decode"),
    (None, ": No such file or directory"),
]


@pytest.mark.parametrize(("text", "message"), FAULTS, ids=[message for _, message in FAULTS])
def test_a_fault_names_file_and_line(tmp_path, text, message):
    file = tmp_path / "mine.yaml"
    if text is not None:
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(ConfigError, match=re.escape(f"{file}{message}")) as error:
        read(file)
    assert len(str(error.value).splitlines()) <= 6


def test_a_directory_is_not_a_config(tmp_path):
    with pytest.raises(ConfigError, match="Is a directory; name a config file"):
        read(tmp_path)


def test_files_are_yaml_1_2(tmp_path):
    """YAML 1.1 reads 8, 90, a text, and true."""
    file = tmp_path / "mine.yaml"
    file.write_text("a: 010\nb: 1:30\nc: 1e-8\nd: yes\n")
    assert read(file) == {"a": 10, "b": "1:30", "c": 1e-8, "d": "yes"}


@pytest.mark.parametrize("file", [*CONFIG_FILES, "config", "reduced"])
def test_files_of_the_project_are_valid(file):
    assert read(config_file(file)) == read_config(file)


def test_keys_are_in_the_order_of_the_first_file(tmp_path):
    """Snakemake begins with the overlay, adds the config of the Snakefile, and merges the overlay again."""
    overlay = {"sweeps": {"heights": {"axes": {"z0": {"num": 41}}}}, "figures": {"fig22": {"section": "4.1"}}}
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(overlay))
    as_snakemake_merges = merged(overlay, read_config(), overlay)
    assert list(as_snakemake_merges["sweeps"]["heights"]["axes"]) == ["z0", "acceleration"]
    loaded = load_config([file], as_snakemake_merges)
    assert list(loaded.config["sweeps"]["heights"]["axes"]) == ["acceleration", "z0"]
    assert loaded.config["sweeps"]["heights"]["axes"]["z0"]["num"] == 41
    assert list(loaded.config["figures"]) == list(read_config()["figures"])


def test_a_config_without_files_is_the_overlay_of_a_module(tmp_path):
    """Another workflow passes its config directly, which has the effect of a file with the same content."""
    overlay = {"prefix": "mine", "model": {"frequency": 100, "mass": 1.0e-3}, "sweeps": {"one": {"axes": {"z0": [0]}}}}
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(overlay))
    loaded = load_config([], overlay)
    from_file = load_config([file], overlay)
    assert repr(loaded[:3]) == repr(from_file[:3])
    assert loaded.stated == from_file.stated
    assert not loaded.is_paper
    assert loaded.config["sweeps"]["one"] == {"axes": {"z0": [0.0]}}


def test_texts_of_numbers_are_numbers():
    """Other workflows read their config as YAML 1.1, in which 1e-8 is a text."""
    overlay = {"prefix": "mine", "solver": {"tolerance": "1e-8", "settling": "2e4"}, "sharing": {"rows": "20000"}}
    overlay |= {"model": {"z0": "1e-4", "damping": "0.3"}, "sweeps": {"one": {"axes": {"z0": ["0", "conveyor"]}}}}
    config = load_config([], overlay).config
    assert config["solver"]["tolerance"] == 1e-8
    assert repr(config["solver"]["settling"]) == "20000"
    assert repr(config["sharing"]["rows"]) == "20000"
    assert (config["model"]["z0"], config["model"]["damping"]) == (1e-4, 0.3)
    assert config["sweeps"]["one"]["axes"] == {"z0": [0.0, "conveyor"]}


def seconds_of_children() -> float:
    """Processor time of child processes (s), which does not depend on the load of the machine."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def test_snakemake_refuses_in_three_seconds_and_ten_lines(project):
    overlay = {"orbits": {"seeds": [{"acceleration": -1.0, "z0": 0.0}] * 200}}
    begin = seconds_of_children()
    new_process = {"LC_ALL": "C.UTF-8"}
    run = Project(project.folder, overlay, new_process).snakemake("--dry-run", "figures/fig22.pdf")
    assert seconds_of_children() - begin < 3.0
    assert_refused(run, "195 more")
    assert "Building DAG" not in run.stdout


def test_snakemake_names_file_line_and_key_of_a_wrong_value(project, tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("prefix: mine\nsweeps:\n  one:\n    axes:\n      z0: [0.0, 1e-4, 99]\n  two: {duration: 1}\n")
    run = project.called("--dry-run", "figures/fig22.pdf", "--configfile", str(file))
    assert_refused(run, "mine.yaml:5: sweeps.one.axes.z0[2] = 99 should be at most 10 (m)")
    assert "mine.yaml:6: sweeps.two.axes is missing; give it (axes of the table" in run.stdout


def test_a_wrong_value_of_the_command_line_is_not_blamed_on_a_file(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("prefix: mine\nmodel: {mass: 1 g, damping: -1}\n")
    with pytest.raises(ConfigError) as error:
        load_config([file], {"model": {"mass": "0.3 mm"}})
    assert "\n--config: model.mass = '0.3 mm' has a unit of another dimension" in str(error.value)
    assert f"\n{file}:2: model.damping = -1 should be" in str(error.value)


def test_overlays_of_two_conveyors_are_not_mixed(tmp_path):
    files = [tmp_path / name for name in ("coarse.yaml", "one.yaml", "two.yaml")]
    for file, text in zip(files, ("sweeps: {}", "model: {mass: 2 g}", "model: {damping: 0.2}"), strict=True):
        file.write_text(f"prefix: {file.stem}\n{text}\n")
    assert load_config(files[:2], {}).config["prefix"] == "one"
    with pytest.raises(ConfigError, match=r"given for one \(.*one.yaml\) and two \(.*mixed\nrun one command for each"):
        load_config(files, {})


def test_nested_values_of_the_command_line_are_an_overlay(project, tmp_path):
    """They are merged over the overlay files, and texts of numbers, as Snakemake passes them, are numbers."""
    overlay = {"prefix": "nested", "sweeps": {"amplitudes": {"model": {"mass": 0.002}, "duration": 0.02}}}
    under = Project(project.folder, overlay | {"model": {"damping": 0.3}})
    values = ("model={damping: 0.2}", "sweeps={amplitudes: {model: {friction: 0.3}, axes: {z0: [0, 1.0e-4]}}}")
    target = "results/nested/sweeps/amplitudes.parquet"
    under.make_in_process(target, "--config", *values)
    settings = pd.read_parquet(project.folder / target).attrs
    assert settings["model"] == settings["model"] | {"damping": 0.2, "mass": 0.002, "friction": 0.3}
    assert settings["axes"]["z0"] == [0.0, 1.0e-4]


CHECK = (sys.executable, "-m", "conveyor_pipeline.config")
WITH_SCRIPTS = os.environ | {"PYTHONPATH": "scripts"}


def test_overlays_can_be_checked_without_snakemake(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("prefix: mine\nmodel: {damping: 0.2\n")
    run = subprocess.run([*CHECK, str(file)], cwd=ROOT, env=WITH_SCRIPTS, capture_output=True, text=True)
    assert run.returncode == 1 and f"{file}:3: is not valid YAML: " in run.stderr
    file.write_text("prefix: mine\nmodel: {damping: 0.2}")
    run = subprocess.run([*CHECK, str(file)], cwd=ROOT, env=WITH_SCRIPTS, capture_output=True, text=True)
    assert run.returncode == 0 and "valid" in run.stdout


def test_the_whole_config_is_shown_with_origins(tmp_path):
    """Also of values that YAML repeats through an anchor, and of texts with a unit."""
    file = tmp_path / "mine.yaml"
    file.write_text(
        "prefix: mine\nsweeps:\n  heights:\n    axes: {z0: {num: 41}}\n  one: {axes: {z0: [0, 1e-4]}}\n"
        "model:\n  friction: 0.2\n  <<: [{damping: 0.2, friction: 0.3}, {damping: 0.4}]\n  angle: 20 deg\n"
    )
    show = [*CHECK, "--show", str(file)]
    run = subprocess.run(show, cwd=ROOT, env=WITH_SCRIPTS, capture_output=True, text=True, check=True)
    shown = dict(line.split(" = ", 1) for line in run.stdout.splitlines())
    assert shown["prefix"] == f'"mine"    # {file}:1'
    assert shown["sweeps.heights.axes.z0.num"] == f"41    # {file}:4"
    assert shown["model.friction"] == f"0.2    # {file}:7"
    assert shown["model.damping"] == f"0.2 N s/m    # {file}:8"
    assert shown["model.angle"] == f"0.3490658503988659 rad    # {file}:9: 20 deg"
    assert shown["sweeps.one.axes.z0"] == f"[0.0, 0.0001] m    # {file}:5"
    assert re.fullmatch(r"0\.0004 m    # config/defaults/paper/sweeps\.yaml:\d+", shown["sweeps.heights.axes.z0.stop"])
    assert re.fullmatch(
        r"400    # config/defaults/paper/sweeps\.yaml:\d+", shown["sweeps.map_height_chaos.axes.psi0.num"]
    )
    assert {key.split(".")[0] for key in shown} == set(read_config())


def test_a_reader_may_end_before_the_whole_config_is_shown():
    """As in `… --show | head`: no traceback."""
    with subprocess.Popen(
        [*CHECK, "--show"], cwd=ROOT, env=WITH_SCRIPTS, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as run:
        run.stdout.close()
        assert run.stderr.read() == ""


def test_the_config_of_the_user_is_an_overlay(tmp_path):
    """It lies below the files of --configfile and the values of --config."""
    folder = copy_project(tmp_path)
    (folder / "config/config.yaml").write_text("prefix: mine\nsweeps: {few: {axes: {z0: [0]}}}\n")
    run = call_snakemake("--dry-run", "results/mine/sweeps/few.parquet", folder=folder)
    assert run.returncode == 0, run.stdout
    run = call_snakemake("--dry-run", "results/other/sweeps/few.parquet", "--config", "prefix=other", folder=folder)
    assert run.returncode == 0, run.stdout


def test_a_deployed_config_works_as_a_module(tmp_path):
    """As snakedeploy writes it: config: config, with the user's file copied, which Snakemake reads as YAML 1.1."""
    (tmp_path / "config").mkdir()
    text = (ROOT / "config/config.yaml").read_text()
    changed = (
        '"sweeps": {few: {axes: {z0: ["0.0", 1e-4]}, duration: "0.02", needs: vertical}}\nsolver: {tolerance: 1e-8}\n'
    )
    (tmp_path / "config/config.yaml").write_text(text + changed)
    (tmp_path / "Snakefile").write_text(
        f'configfile: "config/config.yaml"\nmodule conveyor:\n    snakefile: "{ROOT / "Snakefile"}"\n'
        "    config: config\nuse rule * from conveyor\n"
    )
    run = call_snakemake(*IN_PROCESS_OPTIONS, "results/sweeps/few.parquet", folder=tmp_path)
    assert run.returncode == 0, run.stdout
    assert pd.read_parquet(tmp_path / "results/sweeps/few.parquet").attrs["tolerance"] == 1e-8


def test_braces_in_the_name_of_the_working_directory(tmp_path):
    """A project in such a folder works there; from elsewhere, the folder is named."""
    folder = tmp_path / "b{x}"
    folder.mkdir()
    copy_project(folder)
    run = call_snakemake("--dry-run", "figures/fig22.pdf", "docs/claims.md", folder=folder)
    assert run.returncode == 0, run.stdout
    run = call_snakemake("--dry-run", "figures/fig22.pdf", "--snakefile", str(folder / "Snakefile"), folder=tmp_path)
    assert run.returncode != 0
    assert "b{x} has braces, which Snakemake takes for a wildcard" in run.stdout
