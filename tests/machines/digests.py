"""Digests of small results whose way depends on earlier numbers: searches, labels, a branch, a proof.

`python tests/machines/digests.py` prints a line for each. `.ci/run` runs it with the kernels and instructions of other
processors: all digests must be equal, because one other last digit would lead a search to other points.
"""

import hashlib
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "scripts"), str(ROOT / "tests"), str(ROOT / "tests/machine/calibration")]

import pandas as pd  # noqa: E402
from project import si_config  # noqa: E402
from test_inference import SETTINGS, measured  # noqa: E402

import conveyor  # noqa: E402
from conveyor.analysis.bifurcations.periodic_orbits import ReturnMap  # noqa: E402
from conveyor.certificates.balls import exactly, precision  # noqa: E402
from conveyor.certificates.law import Accuracy, law_of  # noqa: E402
from conveyor.certificates.orbit import prove_orbit  # noqa: E402
from conveyor.certificates.shooting import Shooting  # noqa: E402
from conveyor_pipeline.common import grid  # noqa: E402
from conveyor_pipeline.config.tables import TABLES  # noqa: E402
from conveyor_pipeline.machine.calibration.calibrate import calibrate  # noqa: E402
from conveyor_pipeline.machine.operating import drive  # noqa: E402

CONFIG = si_config()


def calibration():
    alternatives = {"alternatives": {"inclination": 0.2}}
    return calibrate(measured(), SETTINGS | alternatives)


def drive_search():
    own = {"population": 8, "generations": 3, "checked": 2, "starts": 32, "longest": 5.0}
    settings = TABLES["operating/drive_front"](CONFIG) | own
    return drive.make(settings | {"search": settings["search"] | {"parts": 8, "longest": 5.0}})


def labels():
    axes = {"acceleration": [32.0, 44.0, 58.0, 61.0, 70.0], "z0": [0.0, 1e-4, 3e-4]}
    columns, parameters = grid.product(axes, CONFIG["model"])
    return {"labels": pd.DataFrame(columns | dict(conveyor.classify(parameters)))}


def orbits():
    jumping = conveyor.Conveyor(acceleration=54.0)
    orbit = conveyor.periodic_orbit(jumping, conveyor.Start(3e-4))
    branch = conveyor.continue_orbit(orbit, "acceleration", (50.0, 57.0))
    return {"orbits": pd.DataFrame([one._asdict() for one in branch.orbits]), "ends": pd.DataFrame([branch.ends])}


def certificate():
    """The jumping motion at the default amplitude."""
    orbit = conveyor.periodic_orbit(conveyor.Conveyor(), conveyor.Start(3e-4))
    returns = ReturnMap(conveyor.parameter_table(conveyor.Conveyor()), 1)
    with precision(128, 24):
        shooting = Shooting(law_of(conveyor.Conveyor()), Accuracy(order=24, tolerance=1e-22), 1)
        strobe = returns.scaled(orbit.acceleration, orbit.state)[:2]
        proved = prove_orbit(shooting, shooting.law.gamma(exactly(orbit.acceleration)), strobe[None])
        return {"proof": pd.DataFrame([{"trace": str(proved.trace), "enclosure": str(proved.zero.enclosure)}])}


for make in (calibration, drive_search, labels, orbits, certificate):
    for name, table in make().items():
        text = pd.DataFrame(table).to_csv(index=False)
        print(make.__name__, name, hashlib.sha256(text.encode()).hexdigest()[:16], flush=True)
