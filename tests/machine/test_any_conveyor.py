"""The default target and some figures of the paper for conveyors of many kinds, on coarse axes."""

import re
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import pytest
import yaml
from project import IN_PROCESS_OPTIONS, IN_PROCESS_PLUGIN, ROOT, Project

pytestmark = pytest.mark.long

MOST = 2  # builds at a time

FEW = {"acceleration": {"num": 6}}
COARSE = {
    "prefix": "coarse",
    "solver": {"settling": 1000},
    "sweeps": {
        "amplitudes": {"axes": FEW | {"z0": {"num": 2}}, "duration": 0.2},
        "heights": {"axes": {"acceleration": [29.0, 38.0, 47.0], "z0": {"num": 5}}, "duration": 0.2},
        "map_amplitude": {"axes": FEW | {"z0": {"num": 5}}},
    },
    "critical": {
        "edge": {"axes": FEW, "scan": {"num": 9}},
        "edge_euler": {"axes": {"acceleration": [29.0, 38.0]}, "scan": {"num": 3}},
    },
    "regressions": {"height": {"valley": {"num": 9}}},
    "orbits": {"seeds": [], "max_period": 1},
    "attractors": FEW | {"transient": 50, "strobes": 8},
    "operating": FEW | {"resolution": 0.2, "starts": 16},
    "transit": {"acceleration": {"num": 2}, "longest": 2.0, "parts": 8},
    "drift": {"effort": 0.06},
    "track": {"inclination": {"num": 2}, "phase_shift": {"num": 3}, "starts": 4},
}
FIGURES = ("fig03", "fig09", "fig10", "fig12", "bifurcation")

# SI units. On most of these conveyors, something that the paper's conveyor has is missing.
CONVEYORS = {
    # An elliptical drive on a rising track, and a Hooke contact.
    "climbing": {
        **{"frequency": 60.0, "angle": 0.2634, "mass": 0.22, "stiffness": 8.8e5, "exponent": 1.0, "damping": 8.6},
        **{"friction": 0.6, "inclination": 0.01777, "phase_shift": 0.7, "tension": "clip"},
    },
    # Damping takes all energy of an impact, and so no motion jumps.
    "riding": {
        **{"frequency": 100.0, "angle": 0.35, "mass": 5.0e-3, "stiffness": 3.0e5, "damping": 30.0},
        **{"friction": 0.35, "static_friction": 0.45, "tension": "frictionless"},
    },
    # Friction does not hold a part on this track.
    "sliding": {
        **{"frequency": 120.0, "angle": 1.05, "mass": 5.0e-4, "stiffness": 1.0e7, "damping": 0.5},
        **{"friction": 0.2, "inclination": 0.27},
    },
    # Impacts take so little energy that no motion settles within the cycles of this test.
    "undamped": {
        **{"frequency": 50.0, "angle": 0.35, "mass": 0.03, "stiffness": 1.0e8, "damping": 0.05},
        **{"friction": 0.25, "static_friction": 0.35},
    },
}


def build(folder, name: str):
    """Build the default target of a conveyor and FIGURES: the run, and the captions by figure."""
    overlays = []
    for stem, content in (("coarse", COARSE), (name, {"prefix": name, "model": CONVEYORS[name]})):
        overlays.append(str(folder / f"{stem}.yaml"))
        (folder / f"{stem}.yaml").write_text(yaml.safe_dump(content, sort_keys=False))
    (folder / name).mkdir()
    project = Project(folder / name, environment={"PYTHONPATH": IN_PROCESS_PLUGIN, "QUICK_FIGURES": "1"})
    options = (*IN_PROCESS_OPTIONS, "--snakefile", str(ROOT / "Snakefile"))
    targets = [f"results/{name}/captions/{figure}.rst" for figure in FIGURES]
    run = project.called("all", *targets, *options, "--configfile", *overlays)
    captions = (folder / name / f"results/{name}/captions").glob("*.rst")
    return run, {file.stem: " ".join(file.read_text().split()) for file in captions}


@pytest.fixture(scope="module")
def builds(tmp_path_factory):
    folder = tmp_path_factory.mktemp("conveyors")
    with ThreadPoolExecutor(MOST) as pool:
        return folder, dict(zip(CONVEYORS, pool.map(partial(build, folder), CONVEYORS), strict=True))


@pytest.mark.parametrize("name", CONVEYORS)
def test_the_default_target_is_built(builds, name):
    folder, runs = builds
    run, captions = runs[name]
    assert run.returncode == 0, run.stdout[-3000:]
    drawn = {file.stem for file in (folder / name / f"figures/{name}").glob("*.pdf")}
    assert drawn == captions.keys()
    assert drawn == {*FIGURES, "operating", "basin_stability", "transit", "track"}
    assert (folder / name / f"results/{name}/operating/chart.md").exists()
    for caption in captions.values():
        assert not re.search(r"\b(nan|inf|None(?! of))\b", caption), caption
        assert "the paper's conveyor" not in caption
