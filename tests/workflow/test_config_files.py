"""What the files of the config say before Snakemake merges them, and how it is refused."""

import resource

import pytest
import yaml
from project import CONFIG_FILES, ROOT, Project, copy_project, merged, read_config

from workflow.config import canonical
from workflow.config.files import as_first_written, read
from workflow.config.tables import METHOD_SECTIONS, by_methods, resolve

FAULTS = [
    ("model: {mass: 0.1}\nsolver: {}\nmodel: {angle: 0.1}\n", ":3: model stands in line 1 already"),
    ("sweeps:\n  mine:\n    axes: {z0: [0.0], z0: [1.0]}\n", ":3: sweeps.mine.axes.z0 stands in line 3 already"),
    ("model:\n  stiffness: 050\n", ":2: model.stiffness = 050 is read as 40, an octal number"),
    ("model: {stiffness: 1:30}\n", ":1: model.stiffness = 1:30 is read as 90, with base 60"),
    ("sweeps:\n  mine:\n    axes: {z0: [0.0, -1:30.5]}\n", ":3: sweeps.mine.axes.z0[1] = -1:30.5 is read as"),
    ("model: &m {mass: *m}\n", ":1: model.mass contains itself by its anchor"),
    ("model: {mass: 0.1\n", ":2: is not YAML: "),
    ("model:\n\tmass: 0.1\n", ":2: is not YAML: "),
    ("- 1\n", ": holds no mapping"),
    ("", ": holds no mapping"),
    (b"model:\n  # \xe4\n", ":2: is not UTF-8 text"),
    (None, ": No such file or directory"),
]


@pytest.mark.parametrize(("text", "message"), FAULTS, ids=[message for _, message in FAULTS])
def test_a_fault_names_file_line_and_key(tmp_path, text, message):
    file = tmp_path / "mine.yaml"
    if text is not None:
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
    faults, _ = read(file)
    assert faults[0].startswith(f"{file}{message}"), faults


def test_a_directory_is_no_config(tmp_path):
    assert read(tmp_path) == ([f"{tmp_path}: Is a directory; give a config file"], None)


def test_an_anchor_is_told_once(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("a: &a {b: 010}\nc: *a\nd: '050'\ne: 0\nf: 0.5\n")
    assert read(file)[0] == [f"{file}:1: a.b = 010 is read as 8, an octal number; write it without the 0"]


def test_json_is_a_config(tmp_path):
    file = tmp_path / "mine.json"
    file.write_text('{\n\t"model": {"mass": 0.001, "z0": 0},\n\t"sweeps": {}\n}\n')
    assert read(file) == ([], {"model": {"mass": 0.001, "z0": 0}, "sweeps": {}})


@pytest.mark.parametrize("file", [*CONFIG_FILES, "reduced"])
def test_files_of_the_project_are_right(file):
    assert read(ROOT / f"config/{file}.yaml") == ([], read_config(file))


def as_snakemake_merges(overlay: dict) -> dict:
    """Snakemake begins with the overlay and fills in the config of the Snakefile, then the overlay once more."""
    return merged(overlay, read_config(), overlay)


def test_keys_are_in_the_order_of_the_first_file():
    overlay = {"sweeps": {"heights": {"axes": {"z0": {"num": 41}}}}, "figures": {"fig22": {"title": "x"}}}
    config = as_snakemake_merges(overlay)
    assert list(config["sweeps"]["heights"]["axes"]) == ["z0", "acceleration"]
    ordered = as_first_written(config, [read_config(), overlay])
    assert ordered == config
    assert list(ordered["sweeps"]["heights"]["axes"]) == ["acceleration", "z0"]
    assert list(ordered["figures"]) == list(read_config()["figures"])


def test_the_config_of_the_paper_is_in_canonical_form():
    """So that no table changes: what a rule is given has its keys in this order and its numbers in these types."""
    config = plain(read_config())
    found = canonical(config)
    assert found == config
    for section in config.keys() - {*METHOD_SECTIONS, "dimensions"}:
        assert written(found[section]) == written(config[section])
    found, config = by_methods(found), by_methods(config)
    for section in (*METHOD_SECTIONS, "dimensions"):
        for name in config[section]:
            assert written(resolve(found, section, name)) == written(resolve(config, section, name))


def written(value) -> str:
    return yaml.safe_dump(value, sort_keys=False)


def plain(value):
    """A value of its own at each place where YAML has an anchor."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    return [plain(item) for item in value] if isinstance(value, list) else value


@pytest.fixture(scope="module")
def project(tmp_path_factory) -> Project:
    """A copy of the project in which nothing is made."""
    return Project(copy_project(tmp_path_factory.mktemp("refused")))


def seconds_of_children() -> float:
    """Processor time that child processes have taken: a busy machine does not add to it."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


REFUSED = [
    ({"sweep": {}}, "sweep is an unknown key; did you mean sweeps?"),
    ({"sweeps": {"amplitudes": {"axes": {"z0": {"num": 1e12}}}}}, "sweeps.amplitudes.axes.z0.num"),
    ({"prefix": "a\nb"}, "prefix = 'a\\nb' should be a folder name"),
    ({"prefix": "a" * 300}, "prefix"),
    ({1: {}}, "config has a key that YAML reads as 1"),
    ({"figures": {"fig03": {"tables": {"euler": "model/acceleration"}}}}, "figures.fig03.tables.euler"),
    ({"orbits": {"seeds": [{"acceleration": -1.0, "z0": 0.0}] * 200}}, "195 more"),
]


@pytest.mark.parametrize(("overlay", "message"), REFUSED, ids=[message for _, message in REFUSED])
def test_snakemake_refuses_in_ten_lines_and_three_seconds(project, overlay, message):
    begin = seconds_of_children()
    run = project.under(overlay).snakemake("--dry-run", "figures/fig22.pdf")
    assert seconds_of_children() - begin < 3.0
    assert_refused(run, message)
    assert "Building DAG" not in run.stdout


UNREADABLE = [
    (b"model: {mass: 0.1}\nmodel: {mass: 0.2}\n", ":2: model stands in line 1 already"),
    (b"model: [\n", ":2: is not YAML"),
    (b"prefix: \xff\n", ":1: is not UTF-8 text"),
    (None, ": No such file or directory"),
]


def assert_refused(run, message: str) -> None:
    assert run.returncode != 0
    assert message in run.stdout
    assert len(run.stdout.splitlines()) <= 10


@pytest.mark.parametrize(("content", "message"), UNREADABLE, ids=[message for _, message in UNREADABLE])
def test_snakemake_names_file_and_line_of_the_config(project, content, message):
    file = project.folder / "config/config.yaml"
    kept = file.read_bytes()
    file.unlink()
    if content is not None:
        file.write_bytes(content)
    run = project.snakemake("--dry-run", "figures/fig22.pdf")
    file.write_bytes(kept)
    assert_refused(run, f"config/config.yaml{message}")


@pytest.mark.parametrize("option", [["--configfile", "{}"], ["--configfiles={}"]], ids=["apart", "together"])
@pytest.mark.parametrize(("content", "message"), UNREADABLE, ids=[message for _, message in UNREADABLE])
def test_snakemake_names_file_and_line_of_an_overlay(project, tmp_path, content, message, option):
    file = tmp_path / "mine.yaml"
    if content is not None:
        file.write_bytes(content)
    run = project.called("--dry-run", "figures/fig22.pdf", *(part.format(file) for part in option))
    assert_refused(run, f"{file}{message}")


def test_the_profile_for_slurm_names_them_too(project, tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("model: [\n")
    profile = ("--workflow-profile", "workflow/profiles/slurm")
    run = project.called("--dry-run", "figures/fig22.pdf", *profile, "--configfile", str(file))
    assert_refused(run, f"{file}:2: is not YAML")
