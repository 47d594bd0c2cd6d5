"""Another conveyor: the paper's config in the scales of the conveyor, without the parts that belong to the paper."""

import math
import re

import pytest
import yaml
from project import ROOT, Project, merged, read_config

from conveyor.solver.model import Conveyor
from workflow.config import ConfigError, announce, canonical, load_config, problems
from workflow.config.entries import NORMAL, by_methods
from workflow.config.files import DEFAULT_FILES
from workflow.config.own_conveyor import (
    MARKS,
    contact_time,
    is_own_conveyor,
    scale_config,
)
from workflow.config.tables import TABLES, references, settings_of

CONFIG = canonical(read_config())
# The examples that describe a whole conveyor: the contact of `measured` is not known, nor the drive of `accelerometer`.
EXAMPLES = {
    path.stem: path
    for path in sorted((ROOT / "config/examples").glob("*.yaml"))
    if path.stem not in ("measured", "accelerometer")
}
# Figures for any conveyor.
ANY = {f"fig{number:02d}" for number in (3, 8, 9, 10, 12, 13, 14, 17, 18, 19, 20, 22, 23, 24)}
ANY |= {"bifurcation", "operating", "basin_stability"}


def example(name: str) -> dict:
    return yaml.safe_load(EXAMPLES[name].read_text())


def config_of(overlay: dict) -> dict:
    """The whole config of an overlay, as the Snakefile makes it."""
    whole = merged(scale_config(CONFIG, overlay), overlay)
    assert problems(whole) == []
    return by_methods(canonical(whole))


@pytest.mark.parametrize(
    ("overlay", "own"),
    [
        ({}, False),
        ({"prefix": "mine"}, False),
        ({"model": {"friction": 0.2}}, False),
        ({"prefix": "mine", "model": {"acceleration": 50.0, "z0": 0.1}}, False),
        ({"prefix": "mine", "model": {"friction": 0.15}}, False),
        ({"prefix": "mine", "model": {"friction": 0.2}}, True),
    ],
)
def test_a_prefix_and_another_model_make_another_conveyor(overlay, own):
    assert is_own_conveyor(CONFIG, merged(CONFIG, overlay)) == own


def test_overlays_of_the_paper_change_only_the_keys_that_they_name():
    """The reduced config has a prefix, but the paper's conveyor: its axes begin and end where the paper's do."""
    assert not is_own_conveyor(CONFIG, merged(CONFIG, read_config("reduced")))


def test_numbers_keep_their_values_in_the_scales_of_the_conveyor():
    """Twice the frequency under four times the gravity: heights g/ω² stay, velocities double, times halve."""
    found = config_of({"prefix": "mine", "model": {"frequency": 100.0, "gravity": 39.24}})
    assert found["model"]["acceleration"] == 160.0
    assert (found["model"]["frequency"], found["model"]["gravity"]) == (100.0, 39.24)
    assert found["sweeps"]["amplitudes"]["axes"] == {
        "acceleration": {"start": 80.0, "stop": 360.0, "num": 281},
        "z0": {"start": 0.0, "stop": 0.5e-3, "num": 11},
    }
    assert found["sweeps"]["map_velocity"]["axes"]["vz0"] == {"start": -0.4, "stop": 0.4, "num": 400}
    assert found["sweeps"]["map_velocity"]["axes"]["psi0"] == CONFIG["sweeps"]["map_velocity"]["axes"]["psi0"]
    assert found["solver"]["duration"] == 0.5
    assert found["sweeps"]["map_velocity"]["duration"] == 0.01
    assert found["signals"]["states"]["times"]["stop"] == 0.5
    assert found["orbits"]["limits"] == [80.0, 360.0]
    assert found["operating"]["vz0"] == [-0.4, 0.4]
    assert found["estimates"]["height"]["epsilon"] == 5.0e-5
    assert found["figures"]["fig23"]["settings"]["portraits"][2] == [320.0, 0.0]


def test_amplitudes_scale_with_the_vertical_motion():
    angle = math.asin(2.0 * math.sin(CONFIG["model"]["angle"]))
    found = config_of({"prefix": "mine", "model": {"angle": angle}})
    assert found["orbits"]["limits"] == [10.0, 45.0]
    assert found["critical"]["edge"]["scan"] == CONFIG["critical"]["edge"]["scan"]


def test_a_conveyor_of_the_same_scales_has_the_same_axes():
    found = scale_config(CONFIG, {"prefix": "mine", "model": {"damping": 0.4, "friction": 0.3}})
    assert found["operating"] == CONFIG["operating"]
    assert found["attractors"] == CONFIG["attractors"]
    assert found["solver"] == CONFIG["solver"]
    assert found["sweeps"]["map_amplitude"] == CONFIG["sweeps"]["map_amplitude"]
    assert found["model"] == CONFIG["model"] | {"damping": 0.4, "friction": 0.3}


def test_the_step_scales_with_the_contact_time():
    """A contact a hundred times as stiff (p = 1.5: k^(1/3) in the frequency), whole steps in each cycle."""
    assert contact_time(CONFIG["model"]) == pytest.approx(1.0 / (2.0 * math.pi * 255.0), rel=0.01)
    stiff = scale_config(CONFIG, {"prefix": "mine", "model": {"stiffness": 5.0e7}})["solver"]["step"]
    expected = CONFIG["solver"]["step"] * 100.0 ** (-1.0 / 3.0)
    assert 0.95 * expected < stiff <= expected
    assert (1.0 / (50.0 * stiff)) == pytest.approx(round(1.0 / (50.0 * stiff)), abs=1e-6)


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples_are_short_and_unlike_the_paper(name):
    assert len(EXAMPLES[name].read_text().splitlines()) <= 18
    overlay = example(name)
    assert overlay["prefix"] == name
    paper = Conveyor()
    assert overlay["model"]["mass"] > 2.0 * paper.mass
    assert len(overlay["model"]) > 5


@pytest.mark.parametrize("name", EXAMPLES)
def test_parts_that_belong_to_the_paper_are_left_out(name):
    found = config_of(example(name))
    assert set(found["figures"]) >= ANY
    for section in ("figures", "figures_on_request"):
        assert set(found[section]) == {name for name, one in CONFIG[section].items() if "paper_only" not in one}
    assert found["claims"] == {}
    assert "seeds" not in found["orbits"]
    for entry in found["figures"].values():
        assert not set(entry.get("settings", {})) & set(MARKS)
        assert not any("euler" in role for role in entry["tables"])
    methods = {
        entry.get("method", "event")
        for section in ("sweeps", "critical", "estimates", "signals", "spectra", "dimensions")
        for entry in found[section].values()
    }
    assert methods == {"event"}


def test_harmonics_leave_out_what_cannot_take_them():
    harmonic = {"order": 2, "along": 0.1, "along_phase": 0.0, "normal": 0.1, "normal_phase": 1.0}
    found = config_of({"prefix": "mine", "model": {"harmonics": [harmonic]}})
    assert "sensitivity" not in found["figures"]
    assert found["model"]["harmonics"][0]["normal"] == 0.1
    assert "sensitivity" in config_of({"prefix": "mine", "model": {"angle": 0.3}})["figures"]


def test_keys_of_an_overlay_keep_their_values():
    overlay = merged(
        example("bowl"),
        {
            "sweeps": {"amplitudes": {"methods": ["event", "euler"], "axes": {"z0": {"num": 3}}}},
            "critical": {"edge_euler": {"axes": {"acceleration": [30.0]}}},
            "orbits": {"seeds": [{"acceleration": 20.0, "z0": 0.0}]},
            "figures": {"fig04": {"section": "mine"}},
        },
    )
    found = config_of(overlay)
    assert "amplitudes_euler" in found["sweeps"]
    assert "heights_euler" not in found["sweeps"]
    assert found["sweeps"]["amplitudes"]["axes"]["z0"]["num"] == 3
    height = 1.25e-4 * math.cos(math.radians(3.0))  # gravity normal to the climbing track
    assert found["sweeps"]["amplitudes"]["axes"]["z0"]["stop"] == pytest.approx(height, rel=1e-3)
    assert found["figures"]["fig03"]["tables"]["euler"] == "sweeps/amplitudes_euler"
    assert "euler" not in found["figures"]["fig09"]["tables"]
    assert found["figures"]["fig10"]["tables"].keys() == {"converged", "euler", "fit", "fit_euler"}
    assert found["critical"]["edge_euler"]["axes"]["acceleration"] == [30.0]
    assert found["orbits"]["seeds"][0]["acceleration"] == 20.0
    assert found["figures"]["fig04"]["section"] == "mine"
    assert found["figures"]["fig04"]["tables"]["euler"] == "signals/below_above_euler"


@pytest.mark.parametrize(
    ("model", "told"),
    [
        ({"mass": -1.0}, "model.mass = -1.0 should be at least"),
        ({"angle": 0.0}, "model.angle = 0.0 means that no amplitude can lift a part"),
        ({"weight": 1.0, "mass": 1.0}, "model.weight is an unknown key"),
        (3, "model = 3 should be a valid mapping"),
    ],
)
def test_an_impossible_conveyor_is_reported(model, told):
    with pytest.raises(ConfigError, match=re.escape(told)):
        load_config(DEFAULT_FILES, [], {"prefix": "mine", "model": model})


def test_an_overlay_may_give_one_end_of_a_scaled_range():
    """100 m/s² is beyond the paper's range of amplitudes, but not beyond the scaled one."""
    axes = {"acceleration": {"start": 100.0}}
    overlay = {"prefix": "mine", "model": {"gravity": 39.24}, "sweeps": {"amplitudes": {"axes": axes}}}
    amplitudes = load_config(DEFAULT_FILES, [], overlay).config["sweeps"]["amplitudes"]["axes"]["acceleration"]
    assert amplitudes == {"start": 100.0, "stop": 360.0, "num": 281}


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_named_figures_are_planned(name):
    targets = [f"figures/{name}/{figure}.pdf" for figure in sorted(ANY)]
    run = Project(ROOT).called("--dry-run", "--forceall", *targets, "--configfile", str(EXAMPLES[name]))
    assert run.returncode == 0, run.stdout
    for figure in ANY:
        assert f"Draw {figure}\n" in run.stdout


def test_a_figure_that_makes_no_sense_says_so():
    run = Project(ROOT).called("--dry-run", "figures/bowl/fig04.pdf", "--configfile", str(EXAMPLES["bowl"]))
    assert run.returncode != 0
    assert "figures/bowl/fig04.pdf cannot be made for this conveyor: its amplitudes lie" in run.stdout


def test_a_figure_that_takes_no_harmonics_says_so(tmp_path):
    harmonic = {"order": 2, "along": 0.1, "along_phase": 0.0, "normal": 0.1, "normal_phase": 0.0}
    overlay = tmp_path / "mine.yaml"
    overlay.write_text(yaml.safe_dump({"prefix": "mine", "model": {"harmonics": [harmonic]}}))
    run = Project(ROOT).called("--dry-run", "figures/mine/sensitivity.pdf", "--configfile", str(overlay))
    assert run.returncode != 0
    assert "figures/mine/sensitivity.pdf cannot be made for this conveyor: its derivatives" in run.stdout


def test_pages_with_the_papers_results_say_that_they_need_its_config():
    """The site needs the facts."""
    run = Project(ROOT).called("--dry-run", "site", "--configfile", str(EXAMPLES["bowl"]))
    assert run.returncode != 0
    assert "article and site needs the paper's claims, which this config lacks; use the paper's config" in run.stdout


def test_a_figure_of_the_paper_that_the_overlay_names_keeps_its_marks():
    """Its plot cannot be drawn without them."""
    found = config_of(example("bowl") | {"figures": {"fig11": {"section": "mine"}}})
    assert set(found["figures"]["fig11"]["settings"]) == set(CONFIG["figures"]["fig11"]["settings"])
    assert not set(found["figures"]["fig10"].get("settings", {})) & set(MARKS)


def test_figures_and_captions_of_another_conveyor_are_made(built):
    """On the small config: only the converged solution, and captions without the paper."""
    project = built.under({"prefix": "mine", "model": {"frequency": 100.0, "friction": 0.3}})
    figures = ("fig03", "fig08", "fig22")
    made = [f"figures/mine/{figure}.pdf" for figure in figures]
    project.make_in_process(*made, "results/mine/captions/fig03.rst", "results/mine/claims.md")
    for figure in figures:
        assert "the paper" not in (project.folder / f"results/mine/captions/{figure}.rst").read_text()
    assert "are not tested for this one" in (project.folder / "results/mine/claims.md").read_text()
    assert not list((project.folder / "results/mine").rglob("*euler*"))


@pytest.mark.parametrize("changed", [{"phase_shift": 0.5}, {"friction": 0.2}, {"static_friction": 0.3}])
def test_tables_of_the_normal_motion_stay_when_only_the_motion_along_the_track_changes(changed):
    reduced = read_config("reduced")
    paper, own = (load_config(DEFAULT_FILES, [], merged(reduced, {"model": model})).config for model in ({}, changed))
    normal = [
        *(f"sweeps/{name}" for name, entry in paper["sweeps"].items() if entry.get("needs") == "vertical"),
        *(f"{section}/{name}" for section in NORMAL for name in paper[section]),
        *("regressions/height", "estimates/height", "results/settling_times", "sensitivity/continued"),
        *(name for name in TABLES if name.startswith(("orbits/", "attractors/", "lyapunov/"))),
    ]
    found = [name for name in normal if name in references(own)]
    assert len(found) > 20
    assert [name for name in found if settings_of(paper, name) != settings_of(own, name)] == []
    assert settings_of(paper, "sweeps/amplitudes") != settings_of(own, "sweeps/amplitudes")


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_reduced_config_serves_other_conveyors_too(name):
    found = load_config(DEFAULT_FILES, [], merged(read_config("reduced"), example(name)))
    assert found.config["uncertainty"]["claims"] == []
    assert found.config["operating"]["starts"] == read_config("reduced")["operating"]["starts"]


def loaded(tmp_path, *overlays: dict | str) -> dict:
    """The config of overlays, each a file of the project or the content of a file."""
    files = []
    for number, overlay in enumerate(overlays):
        file = ROOT / overlay if isinstance(overlay, str) else tmp_path / f"{number}.yaml"
        if isinstance(overlay, dict):
            file.write_text(yaml.safe_dump(overlay))
        files.append(file)
    contents = [yaml.safe_load(file.read_text()) for file in files]
    return load_config(DEFAULT_FILES, files, merged(*contents)).config


@pytest.mark.parametrize("frequency", [15.0, 16.6667, 30.0, 33.3, 60.0, 100.0, 300.0])
def test_the_reduced_config_serves_any_frequency(tmp_path, frequency):
    """Its steps and durations are scaled together, because not every period is a decimal number."""
    found = loaded(tmp_path, "config/reduced.yaml", {"prefix": "mine", "model": {"frequency": frequency}})
    assert found["prefix"] == "mine"
    assert "edge_euler" not in found["critical"]


def test_overlays_in_front_of_the_conveyor_are_scaled_and_later_ones_are_not(tmp_path):
    coarse = {"prefix": "coarse", "operating": {"resolution": 1.5}, "orbits": {"limits": [25.0, 80.0]}}
    conveyor = {"prefix": "mine", "model": {"gravity": 19.62}}
    found = loaded(tmp_path, coarse, conveyor, {"orbits": {"max_period": 2}})
    assert found["operating"]["resolution"] == 3.0
    assert found["orbits"] | {"model": None} == found["orbits"] | {"model": None, "limits": [50.0, 160.0]}
    assert found["orbits"]["max_period"] == 2
    assert loaded(tmp_path, conveyor, coarse)["operating"]["resolution"] == 1.5
    assert loaded(tmp_path, coarse, conveyor, {"operating": {"resolution": 1.0}})["operating"]["resolution"] == 1.0


SECOND = [{"order": 2, "along": 0.1, "along_phase": 0.0, "normal": 0.1, "normal_phase": 0.0}]


@pytest.mark.parametrize(
    ("overlay", "expected"),
    [
        (
            {"model": {"frequency": 100.0}},
            (
                "itself: heights × 0.25, velocities × 0.5, times × 0.5",
                "led: amplitudes, time steps of fixed-step methods, lengths of track and parts, longest",
            ),
        ),
        (
            {"model": {"gravity": 19.62}},
            ("itself: amplitudes × 2, heights × 2, velocities × 2, ", "led: times, lengths"),
        ),
        ({"model": {"mass": 2.8e-3}}, ("itself: time steps", "methods × 1.429. Not scaled: amplitudes, heights, vel")),
        ({"model": {"friction": 0.2}}, ("paper's. Not scaled: amplitudes, heights, velocities, times, time steps",)),
        ({"model": {"harmonics": SECOND}}, ("fit_valley, sensitivity, harmonics", "interval of its fit; differences")),
        ({"parts": {"mass": 0.1}, "model": {"mass": 2.8e-3}}, ("interval of its fit.",)),
        ({"operating": {"acceleration": [30.0]}}, ()),
    ],
)
def test_the_notice_says_what_was_scaled_and_dropped(tmp_path, overlay, expected):
    file = tmp_path / "own.yaml"
    file.write_text(yaml.safe_dump({"prefix": "own", **overlay}))
    notice = load_config(DEFAULT_FILES, [file], {}).notice
    assert bool(notice) == bool(expected)
    assert [words for words in expected if words not in notice] == []


def test_a_notice_is_printed_once(capsys):
    for _ in range(2):
        announce("own is a conveyor other than the paper's.")
    assert capsys.readouterr().err.count("own is") == 1


def test_lengths_of_tracks_and_parts_and_the_length_of_jobs_are_not_scaled(tmp_path):
    front, own = tmp_path / "front.yaml", tmp_path / "own.yaml"
    front.write_text("transit: {length: 0.7}\nadvice: {part_length: 0.02}\n")
    own.write_text("prefix: own\nmodel: {frequency: 25.0}\n")
    config = load_config(DEFAULT_FILES, [front, own], {}).config
    assert (config["transit"]["length"], config["advice"]["part_length"]) == (0.7, 0.02)
    paper = load_config(DEFAULT_FILES, [], {}).config
    assert config["transit"]["longest"] == paper["transit"]["longest"]
    assert config["sharing"] == paper["sharing"]


def test_an_overlay_that_scales_must_fit_the_paper(tmp_path):
    with pytest.raises(ConfigError, match="is reversed; give"):
        loaded(tmp_path, {"orbits": {"limits": [80.0, 25.0]}}, {"prefix": "mine", "model": {"mass": 0.01}})


def test_scaled_numbers_of_a_list_stay_distinct():
    """Four digits would make 72.97 and 73.0 m/s² equal here."""
    config = merged(CONFIG, {"clean_drive": {"chaos": [72.97, 73.0]}})
    first, second = scale_config(config, {"prefix": "mine", "model": {"angle": 0.1}})["clean_drive"]["chaos"]
    assert first < second


def test_a_forgotten_prefix_is_named_first():
    with pytest.raises(ConfigError, match=r"be used:\nmodel.frequency = 60.0 Hz is .* give it a prefix"):
        load_config(DEFAULT_FILES, [], {"model": {"frequency": 60.0}})
    for fault in ({"model": {"frequency": -60.0}}, {"model": {"friction": 0.3}, "transit": {"longest": 0.01}}):
        with pytest.raises(ConfigError, match=r"be used:\n(model.frequency|transit.longest)"):
            load_config(DEFAULT_FILES, [], fault)


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
