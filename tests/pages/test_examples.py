"""The Python sessions on pages of the site print what the pages show."""

import doctest
import re

import matplotlib
import pandas as pd
import pytest
from project import ROOT

from conveyor import Conveyor, classify, parameter_table

PAGES = ("tutorial", "library", "dynamicists")


@pytest.mark.parametrize("page", PAGES)
def test_sessions_print_what_the_page_shows(page):
    text = (ROOT / f"docs/guides/{page}.md").read_text(encoding="utf-8")
    sessions = re.findall(r"^```pycon\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    assert sessions
    # One session: later blocks use the names of earlier ones.
    test = doctest.DocTestParser().get_doctest("\n".join(sessions), {}, page, None, None)
    assert doctest.DocTestRunner().run(test).failed == 0


def test_the_machine_of_the_tutorial_is_the_one_whose_chart_it_shows():
    page = (ROOT / "docs/guides/tutorial.md").read_text(encoding="utf-8")
    (overlay,) = re.findall(r"^```yaml\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    assert overlay == (ROOT / "docs/guides/feeder.yaml").read_text(encoding="utf-8")


def code_of(page: str) -> list[str]:
    """The Python code on a page."""
    text = (ROOT / f"docs/guides/{page}.md").read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


@pytest.mark.long
def test_the_study_runs(tmp_path, monkeypatch):
    """With fewer points along each axis than the script has."""
    monkeypatch.chdir(tmp_path)
    matplotlib.use("agg")
    code = (ROOT / "docs/guides/study.py").read_text(encoding="utf-8")
    assert code.count("\n") <= 60
    names = {}
    exec(code.replace("SIZE = 100", "SIZE = 32"), names)
    assert len(pd.read_parquet("labels_0.2.parquet")) == 32**2
    assert names["summary"].notna().all(axis=None)
    assert (tmp_path / "study.png").is_file()


def test_the_module_of_the_new_table_fills_its_columns():
    names = {}
    exec(code_of("add_table")[0], names)
    columns = names["make"]({"model": {"damping": 0.2}})
    assert list(columns) == [field.name for field in names["TABLES"]["from_rest"]]
    assert set(columns["status"]) == {"ok"}


def test_the_map_of_states_is_drawn(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    matplotlib.use("agg")
    parameters = parameter_table(Conveyor(), psi0=[[0.0], [1.0], [2.0]], z0=[0.0, 3e-4])
    (tmp_path / "results/sweeps").mkdir(parents=True)
    table = pd.DataFrame({"psi0": parameters["psi0"].ravel(), "z0": parameters["z0"].ravel()})
    table.assign(state=classify(parameters).state.ravel()).to_parquet("results/sweeps/states.parquet")
    (code,) = [code for code in code_of("own_sweep") if "pcolormesh" in code]
    names = {}
    exec(code, names)
    assert names["states"].shape == (2, 3)
    assert (tmp_path / "states.png").is_file()
