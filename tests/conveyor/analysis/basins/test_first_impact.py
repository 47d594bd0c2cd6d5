"""First impacts compared with closed forms, and the motion after them."""

import math

import numpy as np
import pytest

from conveyor import Conveyor, Start, conveyor_and_start, parameter_table, plate_motion, simulate
from conveyor.analysis.basins.first_impact import first_impacts, on_conveyor

G = 9.81
AT_REST = Conveyor(acceleration=0.0)


def starts(conveyor, *pairs):
    return np.stack([parameter_table(conveyor, Start(z, vz)) for z, vz in pairs])


@pytest.mark.parametrize(("z0", "vz0"), [(3e-4, 0.0), (3e-4, -0.2), (0.0, 0.4), (2.0, 1.5)])
def test_a_part_falls_freely_onto_a_plate_at_rest(z0, vz0):
    t1, v1, phase = (values[0] for values in first_impacts(starts(AT_REST, (z0, vz0))))
    assert t1 == pytest.approx((vz0 + math.sqrt(vz0**2 + 2 * G * z0)) / G, rel=1e-12)
    assert v1 == pytest.approx(-math.sqrt(vz0**2 + 2 * G * z0), rel=1e-12)
    assert phase == pytest.approx(2 * math.pi * 50.0 * t1, rel=1e-12)


def test_a_part_meets_a_moving_plate_at_its_height():
    z0 = np.linspace(0.0, 5e-4, 21)
    for psi0 in (0.0, 2.0, 5.0):
        conveyor = Conveyor(acceleration=60.0, psi0=psi0)
        t1, v1, _ = first_impacts(starts(conveyor, *((z + 1.3e-4, 0.05) for z in z0)))
        assert plate_motion(conveyor, t1)["z"] == pytest.approx(z0 + 1.3e-4 + 0.05 * t1 - G * t1**2 / 2, abs=1e-16)
        assert v1 == pytest.approx(0.05 - G * t1, rel=1e-14)


def test_starts_on_and_below_the_surface():
    t1, v1, phase = first_impacts(starts(AT_REST, ("conveyor", 0.0), ("conveyor", -0.1), (-1e-6, 0.0)))
    assert t1[:2].tolist() == phase[:2].tolist() == [0.0, 0.0]
    assert v1[:2].tolist() == [0.0, -0.1]
    assert np.isnan([t1[2], v1[2], phase[2]]).all()


def test_the_first_impact_continues_as_the_initial_condition():
    parameters = starts(Conveyor(), (3e-4, 0.0))
    impacts = first_impacts(parameters)
    images = on_conveyor(parameters, impacts)
    assert 0.0 <= images["psi0"][0] < 2 * math.pi
    assert math.isnan(images["z0"][0]) and images["vz0"][0] == impacts.velocity[0]
    times = np.linspace(1e-4, 0.1, 50)  # the force jumps at the impact itself
    here = simulate(*conveyor_and_start(images[0]), duration=0.1).sample(times)
    there = simulate(*conveyor_and_start(parameters[0]), duration=0.2).sample(times + impacts.time[0])
    for name in ("z", "vz", "contact_force"):
        assert here[name] == pytest.approx(there[name], rel=1e-7, abs=1e-10)
