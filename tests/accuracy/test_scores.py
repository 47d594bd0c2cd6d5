"""The open benchmark: its reference, and the scores of a solver's file."""

import json

import numpy as np
import pandas as pd
import pytest
from project import ROOT

import score
from accuracy import published_scene, scores
from conveyor.methods import modes, peers

MODEL = {"acceleration": 40.0, "z0": 3e-4}
SETTINGS = {"scene": "short", "model": MODEL, "duration": 0.06}
HALF_STROKE = '''
def solve(scene, tolerance):
    """Wrong by `tolerance` amplitudes of the plate in x, and exact in z; it has half of the impacts."""
    x = [value + tolerance * scene["scales"]["x"] for value in scene["reference"]["x"]]
    impacts = [[event["time"], "impact"] for event in scene["events"] if event["kind"] == "impact"]
    late = [[time + 1e-6, kind] for time, kind in impacts]
    return {"x": x, "z": scene["reference"]["z"], "events": late if tolerance < 1.0 else late[1:]}
TOLERANCES = (0.5, 2.0)
'''


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with one scene of three cycles."""
    folder = tmp_path_factory.mktemp("benchmark")
    (folder / "short.json").write_text(published_scene.make(SETTINGS))
    return folder


@pytest.fixture(scope="module")
def scene(folder):
    return scores.read_scenes(folder)["short"]


def test_the_reference_agrees_with_an_independent_integrator(scene):
    row = scores.pack_scene(scene)
    run = peers.run(row, scene["duration"], "DOP853", "modes", 1e-13, 10**6)
    end = [scene["reference"][name][-1] for name in ("x", "vx", "z", "vz")]
    assert np.abs((np.array([run.x, run.vx, run.z, run.vz]) - end) / modes.scales(row)).max() < 1e-10


def test_the_scene_is_complete(scene):
    assert scene["parameters"]["stiffness"] == {"value": 5e5, "unit": "N/m^p", "description": "contact stiffness k_c"}
    assert scene["initial"] == {"x": 0.0, "vx": 0.0, "z": 3e-4, "vz": 0.0}
    assert scene["times"][-1] == scene["duration"] == 0.06
    assert scene["events"][0]["kind"] == "impact"
    for name, bars in scene["error"].items():
        assert len(bars) == len(scene["reference"][name]) == published_scene.SAMPLES
        assert min(bars) > 0.0
        assert np.all(np.diff(bars) >= 0.0)
    assert scores.error_bar(scene) < 1e-9


def test_an_error_bar_is_not_smaller_at_a_later_crossing():
    reference = np.ones(3)
    bars = published_scene.error_bars(reference, [reference + np.array([1e-3, 0.0, 2e-3]), reference])
    assert bars == pytest.approx([1e-3, 1e-3, 2e-3])


def test_a_toy_solver_is_scored_and_drawn(folder, tmp_path, capsys):
    (tmp_path / "toy.py").write_text(HALF_STROKE)
    chart = tmp_path / "chart.png"
    table = score.main([str(tmp_path / "toy.py"), "--scenes", str(folder), "--chart", str(chart)])
    toy = table[table.solver == "toy"]
    assert toy.run.tolist() == ["tolerance 0.5", "tolerance 2"]
    assert toy.error.to_numpy() == pytest.approx(np.array([0.5, 2.0]) / np.sqrt(2.0))
    assert toy.impact_error.tolist() == pytest.approx([1e-6, np.inf])
    own, euler = (table[table.solver == name] for name in ("this solver", "explicit Euler"))
    assert own.error.min() < 1e-9 < euler.error.min()
    assert own.impact_error.min() < 1e-12 < own.impact_error.max() < 1e-4
    assert chart.stat().st_size > 10_000
    assert "toy" in capsys.readouterr().out


def test_the_example_of_the_page_approaches_the_reference(folder):
    loose, *_, tight = scores.score_file(scores.read_scenes(folder), ROOT / "scripts/accuracy/example_solver.py")
    assert tight["error"] < 0.1
    assert tight["error"] < loose["error"]


def numbers(scene: dict, columns: dict | None = None) -> pd.DataFrame:
    """A file with the reference as the numbers of another program."""
    reference = {name: scene["reference"][name] for name in ("x", "z")}
    table = {"scene": "short", "run": "1e-3", "seconds": 0.25, "time": scene["times"], **reference}
    return pd.DataFrame(table | (columns or {}))


def test_numbers_from_a_file_get_the_scores_of_the_function(folder, scene, tmp_path):
    numbers(scene).sample(frac=1.0, random_state=1).to_csv(tmp_path / "other.csv", index=False)
    (row,) = scores.score_file({"short": scene}, tmp_path / "other.csv")
    assert (row["solver"], row["run"], row["seconds"]) == ("other", "0.001", 0.25)
    assert row["error"] < 1e-12
    assert np.isnan(row["impact_error"])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"scene": "long"}, "no scene 'long'; there are short"),
        ({"time": np.linspace(0.0, 1.0, published_scene.SAMPLES)}, "the times differ from the times of the scene"),
    ],
)
def test_wrong_numbers_are_refused(scene, change, message):
    with pytest.raises(ValueError, match=message):
        list(scores.score_numbers({"short": scene}, "other", numbers(scene, change)))


def test_missing_parts_of_a_file_are_named(scene, tmp_path):
    with pytest.raises(ValueError, match="lacks the columns x"):
        list(scores.score_numbers({"short": scene}, "other", numbers(scene).drop(columns="x")))
    with pytest.raises(ValueError, match=r"z must have one number for each of the 100 times of the scene short"):
        scores.trajectory_error(scene, {"x": scene["reference"]["x"], "z": [0.0]})
    (tmp_path / "empty.py").write_text("")
    with pytest.raises(ValueError, match="has no function solve"):
        scores.score_file({"short": scene}, tmp_path / "empty.py")
    with pytest.raises(ValueError, match="has no scenes"):
        scores.read_scenes(tmp_path / "nowhere")


def test_the_published_scenes_are_complete():
    """The files in the repository."""
    for name, scene in scores.read_scenes(ROOT / "docs/benchmark").items():
        assert json.loads(json.dumps(scene))["scene"] == name
        assert scores.error_bar(scene) < 1e-8
