"""Jobs that run again after a change."""

import os

import pytest
from project import CAPTIONS, FIGURES, TARGETS, permuted, small_config

PLOTS = {"plot": len(FIGURES)}
# A change of content that is valid in every module of the library.
REMARK = ("import numpy as np\n", "import numpy as np  # changed\n")


def test_nothing_after_a_touch(built):
    for file in (
        "scripts/conveyor_pipeline/paper/sweeps/shards.py",
        "scripts/conveyor/solver/contact.py",
        "scripts/conveyor_pipeline/paper/figures/fig22.py",
    ):
        os.utime(built.folder / file)
    assert built.planned(*TARGETS, "figures/fig22.png", "docs/companion.html") == {}


def test_one_plot_after_a_line_width(edited):
    project = edited("scripts/conveyor_pipeline/paper/figures/fig22.py", "linewidth=width", "linewidth=1.0")
    assert project.planned(*TARGETS) == {"plot": 1}


def test_all_plots_and_the_companion_after_the_style(edited):
    project = edited("scripts/conveyor_pipeline/figures/style.py", '"#0072B2"', '"#123456"')
    assert project.planned(*TARGETS, "docs/companion.html") == PLOTS | {"companion": 1}


def test_simulations_after_the_contact(edited):
    project = edited("scripts/conveyor/solver/contact.py", *REMARK)
    assert project.planned(*TARGETS) == {"sweeps": 2, "estimates": 2, **PLOTS}


def test_no_labels_after_the_pairs_of_trajectories(edited):
    project = edited("scripts/conveyor_pipeline/paper/orbits/published_estimates.py", *REMARK)
    assert project.planned(*TARGETS) == {"estimates": 2, "plot": 1}


def test_the_companion_after_its_solver(edited):
    file = "scripts/conveyor_pipeline/pages/companion/solver.js"
    project = edited(file, "const CYCLE_STEP = 1 / 1000;", "const CYCLE_STEP = 1 / 500;")
    assert project.planned("docs/companion.html") == {"companion": 1}


def test_the_companion_after_its_model(built):
    changed = {"companion": {"presets": {"first": {"z0": 1.0e-5}}}}
    assert built.under(changed).planned("docs/companion.html") == {"companion": 1}


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"estimates": {"phase": {"last": 0.5}}}, {"estimates": 2, "plot": 1, "caption": 1}),
        # Fixed steps have no tolerance.
        ({"estimates": {"phase": {"tolerance": 1.0e-9}}}, {"estimates": 1, "plot": 1, "caption": 1}),
        ({"figures": {"fig22": {"marks": {"critical_acceleration": 51.0}}}}, {"plot": 1, "caption": 1}),
    ],
)
def test_only_tables_that_use_it_after_a_config_value(built, change, expected):
    assert built.under(change).planned(*TARGETS, *CAPTIONS) == expected


def test_no_table_of_the_normal_motion_after_its_motion_along_the_track(copied):
    sweeps = {"mine": {"axes": {"acceleration": [30.0, 31.0]}, "needs": "vertical", "duration": 0.02}}
    own, table = {"prefix": "own", "sweeps": sweeps}, "results/own/sweeps/mine.parquet"
    copied.under(own).make_in_process(table)
    along = {"friction": 0.2, "static_friction": 0.3, "phase_shift": 0.5}
    assert copied.under({**own, "model": along}).planned(table) == {}
    assert copied.under({**own, "model": {"inclination": 0.1}}).planned(table) == {"sweeps": 1}


def test_nothing_after_another_order_or_spelling(built):
    targets = (*TARGETS, *CAPTIONS, "results/claims.md")
    assert built.under(permuted(small_config())).planned(*targets) == {}


def test_a_section_may_have_braces_and_reruns_nothing(built):
    """Braces, as in LaTeX, which Snakemake's messages would format."""
    project = built.under({"figures": {"fig22": {"section": "$\\dot{x}_p$ {z}"}}})
    assert project.planned(*TARGETS) == {}
