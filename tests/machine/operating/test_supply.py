"""The range of the amplitude that a supply leaves open, and the advice within it."""

import math

import numpy as np
import pandas as pd
import pytest
from project import merged, read_config

from conveyor_pipeline.config import ConfigError, canonical, load_config, problems
from conveyor_pipeline.config.tables import settings_of
from conveyor_pipeline.machine.operating import advice
from conveyor_pipeline.machine.operating.supply import FORCES, amplitude_range

CONFIG = read_config()
SUPPLY = {"voltage": 0.05, "frequency": 0.5, "resonance": 52.0, "damping_ratio": 0.02, "force": "voltage²"}


def steady_amplitude(frequency, resonance, ratio, force=1.0):
    """Amplitude of the acceleration of ẍ + 2ζω₀ẋ + ω₀²x = F cos ωt, from its equation in complex numbers."""
    omega, own = 2.0 * math.pi * frequency, 2.0 * math.pi * resonance
    return abs(-(omega**2) * force / (own**2 - omega**2 + 2j * ratio * own * omega))


@pytest.mark.parametrize(
    ("force", "power", "of_frequency"), [("voltage²", 2, 0), ("voltage", 1, 0), ("frequency²", 0, 2)]
)
def test_range_is_that_of_a_driven_oscillator(force, power, of_frequency):
    """Below the resonance, the amplitude grows with the frequency."""
    ends = []
    for voltage, frequency in ((0.95, 49.5), (1.05, 50.5)):
        strength = voltage**power * (frequency / 50.0) ** of_frequency
        ends.append(steady_amplitude(frequency, 52.0, 0.02, strength) / steady_amplitude(50.0, 52.0, 0.02))
    assert amplitude_range(SUPPLY | {"force": force}, 50.0) == pytest.approx(tuple(ends), rel=1e-5)
    assert FORCES[force] == (power, of_frequency)


def test_a_resonance_within_the_range_of_the_frequency_has_the_largest_amplitude():
    supply = SUPPLY | {"voltage": 0.0, "frequency": 4.0}
    frequencies = np.linspace(46.0, 54.0, 20001)
    amplitudes = [steady_amplitude(one, 52.0, 0.02) / steady_amplitude(50.0, 52.0, 0.02) for one in frequencies]
    assert amplitude_range(supply, 50.0) == pytest.approx((min(amplitudes), max(amplitudes)), rel=1e-4)


def test_an_ideal_supply_leaves_nothing_open():
    assert amplitude_range(SUPPLY | {"voltage": 0.0, "frequency": 0.0}, 50.0) == (1.0, 1.0)


def test_advice_depends_on_the_supply_only_if_it_is_stated():
    plain = canonical(CONFIG)
    assert settings_of(plain, "operating/advice") == plain["advice"] | {"range": [0.99, 1.01]}
    own = canonical(merged(CONFIG, {"supply": {"voltage": "5 %", "resonance": "52 Hz"}}))
    settings = settings_of(own, "operating/advice")
    assert settings["range"] == list(amplitude_range(SUPPLY, 50.0))
    assert settings["supply"] == SUPPLY


@pytest.mark.parametrize(
    ("supply", "message"),
    [
        (
            {"voltage": 0.1},
            "supply.resonance is missing; give the resonance (Hz) of the drive with its load, or remove",
        ),
        ({"resonance": 52.0, "frequency": 60.0}, "supply.frequency = 60.0 Hz is not below model.frequency = 50.0 Hz"),
        ({"resonance": 52.0, "force": "current"}, "supply.force = 'current' should be 'voltage²', 'voltage' or"),
        ({"resonance": "52 mm"}, "supply.resonance = '52 mm' has a unit of another dimension; give Hz"),
        ({"resonance": 160.0}, "supply.resonance = 160.0 Hz is more than 3 times model.frequency = 50.0 Hz"),
        ({"resonance": 16.0}, "supply.resonance = 16.0 Hz is less than 1/3 of model.frequency = 50.0 Hz"),
        ({"resonance": 160.0}, "along the direction of vibration, at most 150 Hz, or check model.frequency"),
        ({"resonance": 160.0, "force": "frequency²"}, "supply.resonance = 160.0 Hz is more than 3 times"),
        ({"resonance": 52.0, "voltage": 5}, "less than 1 (of the voltage); this is a share: write 5 % or 0.05"),
    ],
)
def test_impossible_supplies_are_refused(supply, message):
    assert any(message in line for line in problems(merged(CONFIG, {"supply": supply})))


def test_a_missing_resonance_has_the_line_of_the_section(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("prefix: mine\nsupply:\n  voltage: 10 %\n")
    with pytest.raises(ConfigError) as error:
        load_config([file], {})
    assert f"\n{file}:2: supply.resonance is missing; give" in str(error.value)


@pytest.mark.parametrize("force", ["voltage", "frequency²"])
def test_drives_other_than_electromagnets_may_run_far_above_their_resonance(force):
    assert problems(merged(CONFIG, {"supply": {"resonance": 3.0, "force": force}})) == []


def test_a_place_is_as_good_as_the_worst_amplitude_of_the_table_within_its_range():
    """The largest quantile lies beside a gap, which a wide range reaches."""
    rows = pd.DataFrame({"velocity_05": [1.0, 1.1, 1.2, 3.0, 0.1, 0.1, 0.1], "spread": [0.5] * 7})
    places = [slice(max(place - 1, 0), place + 2) for place in range(7)]
    measured = []

    def around(place):
        measured.append(place)
        return rows.iloc[places[place]]

    assert advice.choose(rows, around, places.__getitem__)["fast"] == 2
    assert 3 not in measured, "the table alone rules this place out"


def test_range_that_a_controller_must_hold():
    """The quantile falls below nine tenths of its value of 2.0 at 2.2 m/s² above and at 3.5 below the amplitude."""
    amplitudes = np.arange(10.0, 31.0)

    def quantile(amplitude):
        return np.where((amplitude >= 16.5) & (amplitude <= 22.2), 2.0, 1.0)

    held = advice.held_range(
        amplitudes, quantile(amplitudes), 10, lambda at: pd.DataFrame({"velocity_05": quantile(at)})
    )
    assert held == pytest.approx((16.5, 22.2), abs=1.0 / 2**advice.HALVINGS)
    assert advice.held_range(amplitudes, np.ones(21), 10, lambda at: None) == (10.0, 30.0)
    # Parts that move back have no velocity to keep.
    assert np.isnan(advice.held_range(amplitudes, -np.ones(21), 10, lambda at: None)).all()


def test_a_range_goes_on_beyond_the_table_in_its_steps():
    assert advice.beyond(np.array([1.0, 1.5, 2.5]), 0.2, 4.6).tolist() == [0.5, 3.5, 4.5]
    assert advice.beyond(np.array([1.0, 1.5, 2.5]), 1.2, 2.0).tolist() == []
    assert advice.beyond(np.array([1.0]), 0.5, 2.0).tolist() == []
