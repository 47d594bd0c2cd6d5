"""Parts that are named in one place and forgotten in another: a line that names them before any job starts."""

import pytest
from project import ROOT, read_config

from workflow import config_checks, known_names
from workflow.configuration import by_methods, canonical

CONFIG = by_methods(canonical(read_config()))
LIBRARY = config_checks.LIBRARY


@pytest.fixture
def named(monkeypatch):
    """A method of fixed steps that is named and no more."""
    monkeypatch.setitem(LIBRARY, "METHODS", (*LIBRARY["METHODS"], "heun"))


def test_nothing_is_forgotten():
    for check in (config_checks.fixed_steps, config_checks.figures, config_checks.claims):
        assert list(check(CONFIG)) == []


def test_a_method_without_its_parts_is_named(named):
    assert list(config_checks.fixed_steps(CONFIG)) == [
        "method heun: scripts/conveyor/methods/fixed_step.py has no step for it; add one where `integrate` compares "
        "`method`",
        "method heun: EVALUATIONS in scripts/conveyor/methods/fixed_step.py does not say how often it evaluates the "
        "forces; add it",
        "method heun: GROWTH in scripts/conveyor/methods/fixed_step.py does not say how it multiplies a decay; add it, "
        "or None",
        "method heun: METHODS in scripts/figures/style.py has no colour and no name for it; add them",
    ]


def test_a_module_of_findings_that_is_not_listed_is_named(monkeypatch):
    monkeypatch.setattr(config_checks, "keys_of", lambda module, mapping: ["about_chaos"])
    claim = {"claims": {"C01": CONFIG["claims"]["C01"]}}
    assert list(config_checks.claims(claim)) == [
        "claims.C01.finding = 'about_states.critical_acceleration': add about_states to FINDINGS in "
        "scripts/claims/verdicts.py"
    ]


def test_a_number_that_a_caption_asks_for_in_vain_is_named(monkeypatch):
    monkeypatch.setattr(config_checks, "names_of_template", lambda file: {"most_at", "mode"})
    place = "workflow/report/{}.rst asks for {}, but in scripts/figures/captions.py {}"
    assert list(config_checks.numbers_of_caption("fig10")) == [place.format("fig10", "mode", "fig10 does not give it")]
    assert list(config_checks.numbers_of_caption("fig01")) == [
        place.format("fig01", name, "NUMBERS has no function for fig01") for name in ("mode", "most_at")
    ]


def test_templates_tell_what_they_ask_for():
    assert known_names.names_of_template(ROOT / "workflow/report/fig08.rst") == {
        "heights",
        "highest_mm",
        "lowest_mm",
        "paper",
    }


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        ("workflow/rules/fit.smk", '"fit.regressions"', '"fit.nothing"', "scripts/fit/nothing.py is missing"),
        (
            "scripts/docs/copy_page.py",
            "def make(",
            "def made(",
            "scripts/docs/copy_page.py has no function make, which rule claims_page calls",
        ),
        ("scripts/conveyor/methods/fixed_step.py", '"rk4")', '"rk4", "heun")', "method heun: "),
    ],
)
def test_no_job_starts(edited, file, old, new, message):
    run = edited(file, old, new).snakemake("all")
    assert run.returncode != 0
    assert message in run.stdout
    assert "Job stats" not in run.stdout
