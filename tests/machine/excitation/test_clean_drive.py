"""Drives with one harmonic: which are followed, and what is concluded from their transit."""

import itertools

import numpy as np
import pandas as pd
import pytest

from conveyor_pipeline.machine.excitation.clean_drive import drives_of
from conveyor_pipeline.machine.excitation.effects import changes_of, harmless_shares, largest_changes, statement_of

SHARES = (0.02, 0.05, 0.1)
PHASES = (0.0, np.pi / 2.0, np.pi, -np.pi / 2.0)


def drives(riding: float, chaos: float) -> pd.DataFrame:
    """Velocities that a harmonic in quadrature changes by `riding` or `chaos` times its share; the median in halves."""
    rows = []
    for acceleration, regime, gain in ((32.0, "riding", riding), (80.0, "chaos", chaos)):
        cases = [(0, 0.0, np.nan), *itertools.product((2, 3), SHARES, PHASES)]
        for order, share, phase in cases:
            change = 0.0 if order == 0 else gain * share * np.sin(phase)
            rows.append((acceleration, regime, order, share, phase, 0.01 * (1.0 + change), 0.04 * (1.0 + 0.5 * change)))
    names = ["acceleration", "regime", "order", "share", "phase", "velocity_05", "velocity_50"]
    return pd.DataFrame(rows, columns=names).assign(velocity_05_stderr=1e-4, velocity_50_stderr=4e-4)


def test_drives_have_one_harmonic_each_and_phases_over_a_turn():
    found = drives_of({"orders": [2, 3], "shares": [0.02, 0.1], "phases": 8})
    assert len(found) == 1 + 2 * 2 * 8
    assert found[0][:2] == (0, 0.0)
    phases = sorted({phase for order, _, phase in found if order})
    np.testing.assert_allclose(np.diff(phases), np.pi / 4.0)
    assert phases[-1] == pytest.approx(np.pi)


def test_changes_are_relative_to_the_drive_without_a_harmonic():
    changes = changes_of(drives(5.0, 1.0))
    one = changes[(changes.order == 2) & (changes.share == 0.05) & (changes.phase == np.pi / 2.0)]
    by_measure = one[one.acceleration == 32.0].set_index("measure").change
    assert by_measure["velocity_05"] == pytest.approx(0.25)
    assert by_measure["velocity_50"] == pytest.approx(0.125)
    assert changes.stderr.max() == pytest.approx(np.sqrt(2.0) * 0.01)


def test_the_worst_phase_may_slow_parts_down():
    worst = largest_changes(
        drives(-5.0, 1.0).assign(velocity_05=lambda rows: rows.velocity_05.where(rows.phase != -np.pi / 2.0, 0.01))
    )
    own = worst[(worst.acceleration == 32.0) & (worst.order == 3) & (worst.share == 0.1)].set_index("measure").change
    assert own["velocity_05"] == pytest.approx(0.5)


def test_harmless_shares_are_interpolated():
    limits = harmless_shares(drives(2.0, 0.4)).set_index(["acceleration", "order"]).share
    assert limits[32.0, 2] == limits[32.0, 3] == pytest.approx(0.025)
    assert np.isnan(limits[80.0, 2])


@pytest.mark.parametrize(("riding", "chaos", "holds"), [(5.0, 1.0, True), (5.0, 3.0, False), (1.0, 1.0, False)])
def test_the_statement_holds_within_its_limits(riding, chaos, holds):
    table = drives(riding, chaos)
    # Errors with the harmonic of the statement count, those with a larger one do not.
    table.loc[(table.regime == "riding") & (table.share == 0.05), "velocity_05_stderr"] *= 3.0
    table.loc[table.share == 0.1, "velocity_05_stderr"] *= 100.0
    found = statement_of(table)
    assert found["chaos"] == pytest.approx(0.5 * chaos * 0.05)
    assert found["riding"] == pytest.approx(riding * 0.05)
    assert found["riding_medians"][1] <= found["most"] + 1e-12
    assert found["amplitudes"] == [80.0]
    assert found["stderr"]["riding"]["velocity_05"] == pytest.approx(0.03 / (1.0 - 0.05 * riding))
    assert found["stderr"]["chaos"]["velocity_50"] == pytest.approx(0.01 / (1.0 - 0.025 * chaos))
    assert found["holds"] is holds
