"""Another conveyor than the paper's: an overlay with a prefix and a model."""

import re

import pytest
import yaml
from project import ROOT, dry_run, load, merged, read_config

from conveyor_pipeline.config import ConfigError, load_config, problems

# The examples that describe a whole conveyor: the contact of `measured` is not known, nor the drive of `accelerometer`.
EXAMPLES = {
    path.stem: path
    for path in sorted((ROOT / "config/examples").glob("*.yaml"))
    if path.stem not in ("measured", "accelerometer")
}
HARMONIC = {"order": 2, "along": 0.1, "along_phase": 0.0, "normal": 0.1, "normal_phase": 0.0}


@pytest.mark.parametrize(
    ("overlay", "is_paper"),
    [
        ({}, True),
        (read_config("reduced"), True),
        ({"model": {"static_friction": 0.15, "harmonics": [], "friction": 0.15, "frequency": 50}}, True),
        ({"prefix": "mine", "model": {"static_friction": 0.15}}, True),
        ({"prefix": "mine", "model": {"harmonics": []}}, True),
        ({"prefix": "mine", "model": {"friction": 0.2}}, False),
        ({"prefix": "mine", "model": {"static_friction": 0.2}}, False),
        ({"prefix": "mine", "model": {"harmonics": [HARMONIC]}}, False),
        ({"prefix": "mine", "model": {"tension": "clip"}}, False),
        ({"prefix": "mine", "sweeps": {"map_height": {"model": {"frequency": 30.0}}}}, False),
        ({"prefix": "mine", "orbits": {"model": {"damping": 0.2}}}, False),
        ({"prefix": "mine", "sweeps": {"own": {"axes": {"z0": [0.0]}, "model": {"damping": 0.2}}}}, True),
    ],
)
def test_another_value_makes_another_conveyor_and_a_restated_default_does_not(overlay, is_paper):
    assert load_config([], overlay).is_paper == is_paper


@pytest.mark.parametrize(
    ("model", "named"),
    [
        ({"frequency": 60.0}, "model.frequency = 60.0"),
        ({"static_friction": 0.3}, "model.static_friction = 0.3"),
        ({"acceleration": 50.0, "z0": 1.0e-4}, "model.acceleration = 50.0"),
    ],
)
def test_another_model_without_a_prefix_is_refused(model, named):
    with pytest.raises(ConfigError, match=rf"be used:\n{re.escape(named)} differs.* prefix: mine"):
        load({"model": model})
    assert problems(merged(read_config(), {"prefix": "mine", "model": model})) == []


def test_another_model_of_an_entry_of_the_paper_without_a_prefix_is_refused():
    """Its tables would lie, under the paper's verdicts, in the paper's folder."""
    with pytest.raises(ConfigError, match=r"be used:\nsweeps.amplitudes.model.damping = 0.05 differs.* prefix: mine"):
        load({"sweeps": {"amplitudes": {"model": {"damping": 0.05}}}})


@pytest.mark.parametrize("name", EXAMPLES)
def test_axes_of_the_paper_are_what_the_config_says(name):
    paper, own = load({}), load(yaml.safe_load(EXAMPLES[name].read_text()))
    for section in ("sweeps", "estimates", "critical", "orbits", "attractors", "solver", "figures"):
        assert own[section] == paper[section]


def test_figures_of_the_paper_are_drawn_for_another_conveyor_if_named(tmp_path):
    figures = [f"fig{number:02d}" for number in range(1, 25)]
    targets = [f"figures/mine/{figure}.pdf" for figure in figures]
    run = dry_run({"prefix": "mine", "model": {"friction": 0.2}}, tmp_path, *targets)
    assert run.returncode == 0, run.stdout
    for figure in figures:
        assert f"output: figures/mine/{figure}.pdf" in run.stdout


def test_a_figure_that_takes_no_harmonics_says_so(tmp_path):
    run = dry_run({"prefix": "mine", "model": {"harmonics": [HARMONIC]}}, tmp_path, "figures/mine/sensitivity.pdf")
    assert run.returncode != 0
    assert "figures/mine/sensitivity.pdf cannot be made with this config: its bifurcations" in run.stdout


@pytest.mark.parametrize(
    ("target", "subject"),
    {
        "site": "the text of README, article and site",
        "results/mine/claims.md": "the test of the paper's claims",
    }.items(),
)
def test_what_is_about_the_papers_conveyor_is_refused_for_another_one(target, subject, tmp_path):
    run = dry_run({"prefix": "mine", "model": {"friction": 0.2}}, tmp_path, target)
    assert run.returncode != 0
    assert f"{subject} is about the paper's conveyor, but this config has another model" in run.stdout


def test_figures_and_captions_of_another_conveyor_have_no_marks_and_remarks_of_the_paper(built):
    project = built.under({"prefix": "mine", "model": {"frequency": 100.0, "friction": 0.3}})
    targets = ["figures/mine/fig03.pdf", "results/mine/captions/fig03.rst"]
    project.make_in_process(*targets)
    caption = " ".join((project.folder / targets[1]).read_text().split())
    assert "of a part on this conveyor over" in caption and "To the eye" not in caption
    of_paper = " ".join((project.folder / "results/captions/fig03.rst").read_text().split())
    assert "of a part on the paper's conveyor over" in of_paper and "To the eye" in of_paper
