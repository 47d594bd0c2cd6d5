"""Flights: no impact is missed on any conveyor; a search that fails says so."""

import math

import numpy as np
import pytest

from conveyor import Conveyor, Start, parameter_table, plate_motion, simulate, sweep
from conveyor.analysis.basins.first_impact import first_impacts
from conveyor.analysis.bifurcations.bifurcation_diagram import bifurcation_diagram
from conveyor.parameters import RANGES
from conveyor.solver import contact, flight
from conveyor.solver.model import pack

TURN = 2.0 * math.pi


def random_flights(count, seed):
    """Heights above the plate (m), velocities (m/s) and excitations over the whole ranges, log-uniform."""
    generator = np.random.default_rng(seed)

    def between(low, high):
        return float(np.exp(generator.uniform(np.log(low), np.log(high))))

    for _ in range(count):
        gravity, omega = between(*RANGES["gravity"]), TURN * between(*RANGES["frequency"])
        a_z = between(1e-6, RANGES["acceleration"][1])
        theta = generator.uniform(0.0, TURN)
        # Initial conditions near the plate: a little above it, with a small velocity.
        q = between(1e-6, 1e2) * a_z / omega**2
        vz = generator.uniform(-3.0, 3.0) * a_z / omega
        yield (
            q - a_z / omega**2 * math.cos(theta),
            vz,
            q,
            vz - a_z / omega * math.sin(theta),
            theta,
            gravity,
            a_z,
            omega,
        )


def take_off(z, vz, theta, gravity, a_z, omega):
    """The Flight above a plate that moves with a_z (m/s²) and omega (rad/s)."""
    conveyor = Conveyor(acceleration=a_z, angle=0.5 * math.pi, frequency=omega / TURN, gravity=gravity)
    return flight.Flight(z, vz, theta, contact.constants(pack(conveyor, Start()), 1e-10))


def scanned(z, vz, theta, gravity, a_z, omega, times):
    """Gaps (m) of a flight at `times` (s)."""
    return z + vz * times - 0.5 * gravity * times**2 + a_z / omega**2 * np.cos(theta + omega * times)


def test_no_impact_is_missed():
    """It is at or before the first negative gap of a scan with forty samples per cycle."""
    met = 0
    for z, vz, q, rate, theta, gravity, a_z, omega in random_flights(400, seed=1):
        tau, speed = flight.next_impact(take_off(z, vz, theta, gravity, a_z, omega), q, rate, math.inf)
        size = abs(z) + abs(vz) * tau + gravity * tau**2 + a_z / omega**2
        gap, approach = flight.gap(take_off(z, vz, theta, gravity, a_z, omega), tau)
        assert abs(gap) < 1e-14 * size
        assert speed == pytest.approx(max(-approach, 0.0), abs=1e-6 * speed)
        cycles = omega * tau / TURN
        if cycles < 2e4:
            times = np.linspace(0.0, tau, max(100, int(40 * cycles)))[1:-1]
            assert scanned(z, vz, theta, gravity, a_z, omega, times).min() > -1e-13 * size
            met += 1
    assert met > 300


@pytest.mark.parametrize("velocity", [-3.0, -1e-9, 0.0, 1e-9, 0.2, 3.0])
@pytest.mark.parametrize("height", [1e-12, 1e-4, 2.0])
def test_time_of_a_fall(velocity, height):
    """The part is at the lower height then."""
    tau = flight.time_of_fall(velocity, height, 9.81)
    assert (0.5 * 9.81 * tau - velocity) * tau == pytest.approx(height, rel=1e-9, abs=1e-15)
    assert tau > 0.0


def test_largest_gap_agrees_with_a_scan():
    for z, vz, q, rate, theta, gravity, a_z, omega in random_flights(300, seed=2):
        tau, _ = flight.next_impact(take_off(z, vz, theta, gravity, a_z, omega), q, rate, math.inf)
        highest = flight.highest_gap(take_off(z, vz, theta, gravity, a_z, omega), tau)
        top = min(max(vz / gravity, 0.0), tau)
        near = np.clip(top + np.linspace(-1.5, 1.5, 20_001) * TURN / omega, 0.0, tau)
        far = np.linspace(0.0, tau, 20_001)
        largest = scanned(z, vz, theta, gravity, a_z, omega, np.concatenate([near, far])).max()
        assert largest <= highest * (1.0 + 1e-12) + 1e-15 * abs(z)
        assert highest == pytest.approx(largest, rel=1e-6)


def test_a_long_fall_ends_on_the_plate():
    """Strong vibration and weak gravity: earlier, the search ran out of steps and the part fell through."""
    conveyor = Conveyor(acceleration=1e3, gravity=1e-3)
    run = simulate(conveyor, Start(z=1.0), duration=60.0)
    assert run.status == "ok"
    stroke = conveyor.acceleration * math.sin(conveyor.angle) / (TURN * conveyor.frequency) ** 2
    first = run.events[0]
    assert first["kind"] == "impact"
    assert math.sqrt(2.0 * (1.0 - stroke) / 1e-3) <= first["time"] <= math.sqrt(2.0 * (1.0 + stroke) / 1e-3)
    times = np.linspace(0.0, 60.0, 600_001)
    gaps = run.sample(times)["z"] - plate_motion(conveyor, times)["z"]
    assert gaps.min() > -1e-3
    assert run.max_gap == pytest.approx(gaps.max(), rel=1e-6)


def test_a_failed_search_says_so(monkeypatch):
    monkeypatch.setattr(flight, "MAX_STEPS", 2)
    tau, _ = flight.next_impact(take_off(1.0, 0.0, 0.0, 9.81, 8.0, 314.0), 1.0, 0.0, math.inf)
    assert math.isnan(tau)


def test_every_caller_of_a_failed_search_says_so():
    """No time is the root of a flight with a velocity that is not a number."""
    parameters = parameter_table(Conveyor(acceleration=20.0), Start(3e-4)).copy()
    parameters["vz0"] = math.nan
    runs = sweep(parameters, duration=0.1)
    assert runs.status == "impact not found"
    assert math.isnan(runs.z_end) and math.isnan(runs.mean_velocity)
    assert bifurcation_diagram(parameters, transient=0, strobes=1).status == "impact not found"
    assert math.isnan(first_impacts(parameters[None]).time[0])
