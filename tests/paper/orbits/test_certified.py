"""Rows of proofs: columns in SI units, compared with the orbit in floating point."""

import numpy as np
import pytest

from conveyor import Conveyor, Start, initial_states, parameter_table
from conveyor.analysis.bifurcations import periodic_orbits
from conveyor_pipeline.paper.orbits import certified

SETTINGS = {"model": {}}


def test_the_row_of_a_riding_part():
    """It is never in the air; penetration, speed of approach and period agree with the orbit in floating point."""
    row = parameter_table(Conveyor(acceleration=30.0), Start())
    state = initial_states(row[None], tolerance=periodic_orbits.ORBIT_TOLERANCE)[0]
    orbit = periodic_orbits.settled_orbit(row, state, (1,), 1000)
    returns = periodic_orbits.ReturnMap(row, 1)
    about = certified.float_orbit(7, returns, returns.scaled(30.0, orbit.state))
    found, _ = certified.run_task(SETTINGS, certified.Task("certificates", (about,)))
    assert found["contained"]
    assert (found["branch"], found["period"], found["impacts"], found["stability"]) == (7, 1, 0, "stable")
    assert orbit.state[0] > 0.0
    for name, value in (("delta", orbit.state[0]), ("v", orbit.state[1])):
        np.testing.assert_allclose([found[f"{name}_low"], found[f"{name}_high"]], value, rtol=1e-9, atol=1e-13)
    for name in ("duration", "contact_time"):
        assert found[f"{name}_low"] <= 0.02 <= found[f"{name}_high"]
        assert found[f"{name}_high"] - found[f"{name}_low"] < 1e-17
    assert np.isnan(found["impact_phase_low"])
    damping = Conveyor().damping / Conveyor().mass
    assert found["determinant_low"] == pytest.approx(np.exp(-damping * 0.02), rel=1e-12)


def test_the_shortest_excursion_that_can_be_proved_is_taken(monkeypatch):
    def prove(system, centres, axes):
        if len(centres) < 3:
            raise certified.Refused(f"{len(centres)} sets are too few")
        return f"proved by {len(centres)} sets"

    monkeypatch.setattr(certified, "prove_horseshoe", prove)
    plans = [(np.zeros((count, 2)), []) for count in (1, 2, 3, 4)]
    assert certified.prove_shortest(None, iter(plans)) == "proved by 3 sets"
    with pytest.raises(certified.Refused, match="2 sets are too few"):
        certified.prove_shortest(None, iter(plans[:2]))
    with pytest.raises(certified.Refused, match="too few"):
        certified.prove_shortest(None, iter(plans[:1] * certified.MOST_EXCURSIONS + plans[2:]))
