"""Tables of signals, spectra and first impacts on small configs."""

import numpy as np
import pytest

from conveyor import Conveyor, Start, plate_motion, simulate
from conveyor_pipeline.common import fields, tables
from conveyor_pipeline.paper.motion import signals, spectra

MODEL = {"z0": 0.0, "vz0": 0.0}


def settings(**others):
    return {
        "model": MODEL,
        "method": "event",
        "tolerance": 1e-10,
        "duration": 0.1,
        "settling": 2000,
        **others,
    }


def frame(stage, entry):
    """The table of an entry after writing and reading."""
    (kind, columns), *_ = stage.TABLES.items()
    schema = [*(fields.AXES[axis] for axis in entry["axes"]), *columns]
    return tables.make(kind, schema, stage.make(entry), entry).to_pandas()


def test_a_part_rests_on_a_conveyor_at_rest():
    entry = settings(axes={"acceleration": [0.0]}, times={"start": 0.09, "stop": 0.1, "num": 3})
    table = frame(signals, entry)
    assert table.time.tolist() == pytest.approx([0.09, 0.095, 0.1])
    assert table.contact_force.tolist() == pytest.approx([0.7e-3 * 9.81] * 3, rel=1e-6)
    still = ["x", "vx", "vz", "friction_force", "plate_x", "plate_vx", "plate_z", "plate_vz"]
    assert table[still].abs().max(axis=None) < 1e-9


@pytest.mark.parametrize("method", ["event", "euler"])
def test_plate_columns_are_the_motion_of_the_plate_at_each_point(method):
    accelerations = [30.0, 60.0]
    entry = settings(axes={"acceleration": accelerations}, times={"start": 0.0, "stop": 0.02, "num": 9}, method=method)
    entry |= {"step": 1e-5, "duration": 0.02}
    table = frame(signals, entry)
    for acceleration in accelerations:
        rows = table.query("acceleration == @acceleration")
        motion = plate_motion(Conveyor(acceleration=acceleration), np.linspace(0.0, 0.02, 9))
        for name, values in motion.items():
            assert rows[f"plate_{name}"].to_numpy() == pytest.approx(values, rel=1e-14)
        assert rows.contact_force.notna().all()


def test_spectrum_of_a_period_has_the_mean_velocity_and_only_harmonics():
    entry = settings(axes={"z0": [3e-4]}, duration=2.0)
    entry["model"] = {"vz0": 0.0}
    table = frame(spectra, entry)
    feeding = table.query("signal == 'vx'")
    assert feeding.amplitude.iloc[0] == pytest.approx(0.0650828, rel=1e-3)
    assert np.allclose(feeding.frequency % 25.0, 0.0)
    rise = table.query("signal == 'vz'").amplitude
    assert rise.iloc[0] < 1e-4 * rise.max()


def test_spectrum_of_chaos_is_windowed():
    entry = settings(axes={"acceleration": [80.0]}, duration=1.0)
    table = frame(spectra, entry)
    assert sorted(table.frequency.unique())[1] == pytest.approx(4.0)


def test_a_spectrum_covers_the_last_period():
    """The value at frequency 0 is the mean velocity, which still grows here."""
    run = simulate(Conveyor(), Start(3e-4), duration=0.1)
    found = spectra.spectra_of_end(run, 2)["vx"]
    ends = run.sample([0.06, 0.1])["x"]
    assert found.frequency[1] == pytest.approx(25.0)
    assert found.amplitude[0] == pytest.approx((ends[1] - ends[0]) / 0.04, rel=1e-3)
