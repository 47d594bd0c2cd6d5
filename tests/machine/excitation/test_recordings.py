"""Recordings as loggers write them: right within their intervals, or refused with the cause and the value that fits."""

import gzip
import re
from dataclasses import replace

import numpy as np
import pytest
import yaml
from accelerometer import Drive, check, table_of

from conveyor_pipeline.common.csv_table import TableError, read_text
from conveyor_pipeline.config import ConfigError, load_config
from conveyor_pipeline.config.files import read
from conveyor_pipeline.machine.excitation import measure
from conveyor_pipeline.machine.excitation.reading import MOST_BYTES, STANDARD_GRAVITY, UNITS, turn
from conveyor_pipeline.machine.excitation.sample_times import CHECKED, EVEN, ROUNDED, STAMPED, resolve
from conveyor_pipeline.machine.excitation.saturation import has_flat_tops

PURE = Drive(cycles=100.0, rate=1600.0, noise=0.1, bias=(0.0, 0.0), mount=0.2)
TIMES, READINGS = PURE.record()
TIMES = TIMES - TIMES[0]


def text_of(time, readings, header="time,x,z", digits=7, separator=","):
    """The file of a logger."""
    lines = (
        separator.join([f"{t:.{digits}f}", f"{x:.4f}", f"{z:.4f}"]) for t, (x, z) in zip(time, readings.T, strict=True)
    )
    return "\n".join([header, *lines, ""])


def sampled(rate, count=3200, **changes):
    """Times and readings of a drive that is sampled evenly."""
    drive = replace(PURE, rate=rate, cycles=count * PURE.frequency / rate, **changes)
    time, readings = drive.record()
    return time - time[0], readings


def estimates(text, **settings):
    """Values and standard errors of the parameters, the orders above the noise, and the quality."""
    settings = {**PURE.settings, "measured": "mine.csv", **settings}
    check(text, settings)
    made = measure.make(text, settings)
    values = dict(zip(made["parameters"]["parameter"], made["parameters"]["value"], strict=True))
    errors = dict(zip(made["parameters"]["parameter"], made["parameters"]["stderr"], strict=True))
    harmonics = made["harmonics"]
    orders = [order for order, above in zip(harmonics["order"], harmonics["above_noise"], strict=True) if above]
    return values, errors, orders, {name: column[0] for name, column in made["quality"].items()}


def fault_of(text, **settings):
    """What the check says about a file."""
    with pytest.raises(TableError) as error:
        check(text, {**PURE.settings, **settings})
    return str(error.value)


def assert_right(found):
    values, errors, orders, _ = found
    for name in values:
        # Three of four parameters would be within 1.96 standard errors; a fault of the times makes tens of them.
        assert abs(values[name] - getattr(PURE, name)) < 3.5 * errors[name], name
    assert orders == []


def buffered(time, length, bus):
    """Times of a host that reads buffers of a sensor."""
    first = np.repeat(time[::length], length)[: len(time)]
    return first + (np.arange(len(time)) % length) / bus


@pytest.mark.parametrize("rate", [400.0, 640.0, 800.0, 1344.0])
@pytest.mark.parametrize("cut", [np.round, np.floor])
def test_times_in_milliseconds_count_as_evenly_spaced(rate, cut):
    time, readings = sampled(rate)
    found = estimates(text_of(cut(1000.0 * time) / 1000.0, readings, digits=3))
    assert_right(found)
    assert found[3]["sampling"] == ROUNDED


@pytest.mark.parametrize(("length", "bus"), [(8, 3200.0), (16, 1700.0), (32, 1e4), (16, np.inf)])
def test_buffers_with_the_time_of_the_host_count_as_evenly_spaced(length, bus):
    found = estimates(text_of(buffered(TIMES, length, bus), READINGS))
    assert_right(found)
    assert found[3]["sampling"] in (ROUNDED, EVEN)
    assert found[3]["rate_error"] < 1e-3


def test_buffers_that_fit_two_frequencies_are_refused_with_what_decides():
    """Stamped 3.5 times too fast, buffers of 16 samples show 50 Hz as 50 Hz plus the rate of the buffers, too."""
    rate = 1600.0 * 50.0 / 40.0  # so that 3.5 · 50 Hz = 50 Hz + rate/16
    time, readings = sampled(rate, noise=0.5)
    text = text_of(buffered(time, 16, 3.5 * rate), readings)
    assert "state model.frequency, and excitation.rate: 2000 if" in fault_of(text)
    assert_right(estimates(text, rate=rate))


def test_random_delays_of_the_host_count_as_evenly_spaced():
    delays = np.random.default_rng(3).uniform(0.0, 0.9, len(TIMES)) / PURE.rate
    found = estimates(text_of(TIMES + delays, READINGS))
    assert_right(found)
    assert found[3]["sampling"] == EVEN


@pytest.mark.parametrize("times", [2, 4, 2.5])
def test_lines_of_a_sensor_that_is_read_too_often_are_left_out(times):
    time, readings = sampled(500.0, 1000)
    polled = np.arange(int(times * len(time))) / (times * 500.0)
    row = np.floor(polled * 500.0 + 1e-9).astype(int)
    found = estimates(text_of(polled, readings[:, row]))
    assert_right(found)
    assert found[3]["repeated"] == len(polled) - len(time)


def test_steps_of_a_converter_are_no_repeated_readings():
    time, readings = sampled(8000.0, 3200)
    text = text_of(time, 2.0 * np.round(readings / 2.0))
    assert check(text, PURE.settings).repeated == 0


@pytest.mark.parametrize(
    "changes", [{"jitter": 0.3}, {"random": True}, {"gap": (0.3, 0.5)}, {"harmonics": ((2, 0.05, 0.3, 0.08, 2.0),)}]
)
def test_right_times_stay_as_they_are(changes):
    drive = replace(PURE, **changes)
    recording = check(drive.text(), drive.settings)
    assert recording.sampling == STAMPED and recording.repeated == 0
    np.testing.assert_allclose(recording.time, drive.record()[0] - drive.record()[0][0], atol=1e-8)


@pytest.mark.parametrize("every", [3, 4, 8, 10, 25, 100])
def test_lost_samples_are_refused_also_where_they_look_like_harmonics(every):
    kept = np.arange(len(TIMES)) % every != every - 1
    text = text_of(TIMES[: kept.sum()], READINGS[:, kept])
    assert f"If one of {every} samples is lost, the drive vibrates at 50" in fault_of(text)


@pytest.mark.parametrize("ratio", [2.0, 2.5, 3.7])
@pytest.mark.parametrize("columns", ["xz", "z"])
def test_a_slower_sensor_that_is_interpolated_is_refused(ratio, columns):
    time, readings = sampled(1600.0, noise=0.3)
    finer = np.arange(int(ratio * (len(time) - 1))) / (ratio * 1600.0)
    _, made = sampled(ratio * 1600.0, count=len(finer), noise=0.3)
    for name, one in zip("xz", readings, strict=True):
        if name in columns:
            made["xz".index(name)] = np.interp(finer, time, one)
    assert f"of the samples of the column {columns[0]} on straight lines" in fault_of(text_of(finer, made))


def test_interpolation_at_a_multiple_of_the_drive_is_refused():
    """Twenty samples in each cycle of 50 Hz: few different phases, but noise that makes the samples different."""
    time, readings = sampled(500.0, noise=0.3)
    finer = np.arange(2 * len(time) - 1) / 1000.0
    made = np.array([np.interp(finer, time, one) for one in readings])
    assert "of the samples of the column x on straight lines" in fault_of(text_of(finer, made))
    _, own = sampled(1000.0, count=len(finer), noise=0.3)
    assert check(text_of(finer, own), PURE.settings).sampling == STAMPED


@pytest.mark.parametrize("phase", np.arange(0.0, 6.0, 0.5))
def test_a_slow_sway_is_not_taken_for_interpolation(phase):
    """In few phases, with readings in coarse steps: the sway is large, but changes hardly from sample to sample."""
    time, readings = sampled(800.0, noise=0.01)
    sway = 2.0 * np.sin(2.0 * np.pi * 0.7 * time + phase)
    check(text_of(time, 0.04 * np.round((readings + sway) / 0.04)), PURE.settings)


@pytest.mark.parametrize(("ratio", "share"), [(1.2, 16), (2.0, 50), (4.0, 75)])
def test_a_slower_channel_that_is_held_is_refused(ratio, share):
    time, readings = sampled(1000.0, noise=0.3)
    held = np.floor(np.floor(np.arange(len(time)) / ratio) * ratio).astype(int)
    fault = fault_of(text_of(time, np.array([readings[0], readings[1, held]])))
    assert f"repeats the reading of the line before in {share} % of the lines of the column z" in fault
    assert "straight lines" not in fault


LATE = {  # what happens to a part of a long recording, from then on, and a part of the message
    "the drive stops": (lambda time, readings: 0.0 * readings, "is not steady: its amplitude"),
    "the amplitude rises": (lambda time, readings: 1.5 * readings, "is not steady: its amplitude"),
    "samples are lost": (lambda time, readings: readings[:, np.arange(len(time)) * 10 // 9 % len(time)], "lost"),
}


@pytest.mark.parametrize("change", LATE)
def test_what_happens_late_in_a_long_recording_is_refused(change):
    change, message = LATE[change]
    time, readings = sampled(1600.0, count=42_000)
    late, offsets = time > 22.0, np.array(PURE.offsets)[:, None]
    assert np.count_nonzero(~late) > CHECKED
    readings[:, late] = change(time[late], readings[:, late] - offsets) + offsets
    text = text_of(time, readings)
    check(text, PURE.settings)  # the start of a build looks at the beginning alone
    with pytest.raises(TableError, match=message):
        measure.make(text, {**PURE.settings, "measured": "mine.csv"})


@pytest.mark.parametrize(("frequency", "rate"), [(50.0, 1613.7), pytest.param(6.0, 25_600.0, marks=pytest.mark.long)])
def test_long_recordings_without_faults_are_accepted(frequency, rate):
    drive = replace(PURE, frequency=frequency, acceleration=20.0, rate=rate, cycles=frequency * 66_000 / rate)
    time, readings = drive.record(3)
    text = text_of(time, readings)
    assert len(check(text, PURE.settings).time) > 2 * CHECKED
    made = measure.make(text, {**PURE.settings, "measured": "mine.csv"})
    assert made["parameters"]["value"][0] == pytest.approx(20.0, rel=1e-3)


def test_a_wrong_scale_of_one_axis_is_part_of_the_error_of_the_angle():
    drive = replace(PURE, mount=0.0)
    time, readings = drive.record()
    for scale in (0.95, 1.05):
        values, errors, *_ = estimates(text_of(time, readings * [[1.0], [scale]]), mount=0.0)
        assert abs(values["angle"] - drive.angle) < 2.5 * errors["angle"] < 0.025


@pytest.mark.parametrize("share", [0.02, 0.15])
def test_failed_readings_are_refused(share):
    readings = READINGS.copy()
    failed = np.flatnonzero(np.random.default_rng(2).random(len(TIMES)) < share)
    readings[0, failed] = 0.0
    message = f"mine.csv:{failed[0] + 2}: and {len(failed) - 1} further lines have x = 0, as where readings fail"
    assert message in fault_of(text_of(TIMES, readings))


@pytest.mark.parametrize("limit", [0.3, 0.5, 0.7])
def test_peaks_that_are_cut_off_by_a_third_are_refused_also_at_few_phases(limit):
    offset = PURE.offsets[0]
    most = limit * np.abs(READINGS[0] - offset).max()
    readings = READINGS.copy()
    readings[0] = np.clip(readings[0], offset - most, offset + most)
    readings[0] += 0.05 * np.random.default_rng(1).standard_normal(len(TIMES))
    assert "has cut-off peaks in the column x" in fault_of(text_of(TIMES, readings))


def test_random_harmonics_make_no_flat_tops():
    random, theta = np.random.default_rng(1), 2.0 * np.pi * np.arange(2000) / 31.7
    for _ in range(200):
        wave = np.cos(theta)
        for order in random.choice([2, 3, 4, 5], random.integers(0, 4), replace=False):
            wave += random.uniform(0.0, 0.3) * np.cos(order * theta + random.uniform(0.0, 2.0 * np.pi))
        assert not has_flat_tops(wave)


@pytest.mark.parametrize("settings", [{}, {"time_unit": "s"}])
def test_times_in_minutes_are_refused(settings):
    fault = fault_of(text_of(TIMES / 60.0, READINGS, header="time (min),x,z", digits=9), **settings)
    assert "states times in min; export them in one of s, ms" in fault


def test_a_drive_that_hunts_is_called_so():
    time, _ = sampled(1600.0)
    swung = time + 0.1 * np.sin(2.0 * np.pi * 5.0 * time) / (2.0 * np.pi * PURE.frequency)
    along, normal = PURE.plate(swung)
    readings = turn(np.array([along, normal]), -PURE.mount) + np.array(PURE.offsets)[:, None]
    readings += 0.1 * np.random.default_rng(1).standard_normal(readings.shape)
    assert "has a phase that swings by 0.1 rad at 5 Hz: the drive hunts" in fault_of(text_of(time, readings))


def test_a_clock_that_changes_its_rate_is_part_of_the_error_of_the_frequency():
    time = TIMES + 1e-3 * np.maximum(TIMES - 0.5 * TIMES[-1], 0.0)
    values, errors, _, _ = estimates(text_of(time, READINGS))
    assert abs(values["frequency"] - PURE.frequency) < 1.96 * errors["frequency"]


@pytest.mark.parametrize("count", [1, 3, 30])
@pytest.mark.parametrize("noise", [0.02, 1.0])
def test_samples_that_are_lost_at_random_are_refused_with_their_number(count, noise):
    """The frequency would be wrong by count/3200, and no line of the spectrum shows it."""
    time, readings = sampled(1600.0, noise=noise)
    kept = np.ones(len(time), dtype=bool)
    kept[np.random.default_rng(count).choice(np.arange(500, 2700), count, replace=False)] = False
    fault = fault_of(text_of(time[: kept.sum()], readings[:, kept]))
    found = re.search(r"about (\d+) samples are lost", fault)
    if found:
        assert 0.3 * count <= float(found[1]) <= 3.0 * count
    else:
        assert count == 1 and "follows a jump of the phase" in fault


@pytest.mark.parametrize("share", [0.01, 0.03])
@pytest.mark.parametrize("rate", [600.0, 800.0])
def test_many_samples_that_are_lost_at_random_are_no_unsteady_drive(share, rate):
    """The phase turns so often that the fundamental nearly vanishes in some pieces."""
    time, readings = sampled(rate)
    kept = np.random.default_rng(int(rate)).random(len(time)) > share
    fault = fault_of(text_of(time[: kept.sum()], readings[:, kept]))
    assert re.search(r"samples are lost|the times are not those of the samples", fault), fault


@pytest.mark.parametrize(
    ("cycles", "place", "noise"), [(0.97, 0.5, 0.5), (1.02, 0.3, 0.3), (2.5, 0.8, 1.0), (0.1, 0.6, 1.0)]
)
def test_a_block_that_is_lost_is_refused(cycles, place, noise):
    """The jump of the phase may be small, if nearly whole cycles are lost."""
    time, readings = sampled(1730.0, noise=noise)
    begin = round(place * len(time))
    kept = np.ones(len(time), dtype=bool)
    kept[begin : begin + round(cycles * 1730.0 / PURE.frequency)] = False
    fault = fault_of(text_of(time[: kept.sum()], readings[:, kept]))
    assert "follows a jump of the phase by" in fault
    assert abs(int(fault.split(":")[1]) - begin) < 0.05 * len(time)


def test_a_small_jump_is_refused_or_part_of_the_error_of_the_frequency():
    outside = 0
    for seed in range(12):
        time, readings = replace(PURE, noise=2.0, cycles=60.0, rate=1633.0).record(seed)
        kept = np.ones(len(time), dtype=bool)
        kept[900:998] = False  # 3.0006 cycles, or a sample more
        kept[998] = seed % 2 == 0
        text = text_of(time[: kept.sum()] - time[0], readings[:, kept])
        try:
            values, errors, _, _ = estimates(text)
        except TableError as error:
            assert "jump" in str(error)
        else:
            outside += abs(values["frequency"] - PURE.frequency) > 1.96 * errors["frequency"]
    assert outside <= 2


def test_a_jump_of_a_small_part_of_a_sample_is_no_loss():
    """Coarse readings at nearly the same phases in each cycle move in steps, which looks like such a jump."""
    coarse = Drive(acceleration=36.0, angle=0.35, noise=0.02, quantum=1.2)
    for per_cycle, count, phase_shift, psi0 in ((19.9996, 2070, 0.97, -1.09), (16.00048, 1775, -0.14, -2.44)):
        sampling = {"rate": per_cycle * coarse.frequency, "cycles": count / per_cycle}
        drive = replace(coarse, phase_shift=phase_shift, psi0=psi0, **sampling)
        check(drive.text(1), drive.settings)


@pytest.mark.parametrize("rate", [500.0, 800.0, 1600.0])
def test_a_drive_that_is_switched_on_in_the_file_is_no_second_sensor(rate):
    time, readings = sampled(rate, count=round(0.4 * rate))
    mean = np.array(PURE.offsets)[:, None]
    readings = mean + (readings - mean) * (1.0 - np.exp(-time / 0.004))
    values, errors, _, _ = estimates(text_of(time, readings))
    assert abs(values["acceleration"] - PURE.acceleration) < 3.5 * errors["acceleration"]


def test_harmonics_at_uneven_times_are_no_second_sensor():
    harmonics = ((3, 0.25, 1.0, 0.25, -2.0), (5, 0.25, -1.0, 0.25, 0.5))
    drive = replace(PURE, acceleration=118.0, angle=0.9, jitter=0.3, rate=612.5, harmonics=harmonics)
    for seed in range(8):
        time, readings = drive.record(seed)
        check(text_of(time, readings), PURE.settings)


def test_a_stated_frequency_rules_a_loss_of_samples_out():
    drive = Drive(
        acceleration=49.0,
        angle=1.136,
        psi0=3.0,
        rate=400.0,
        cycles=52.5,
        noise=0.08,
        mount=0.0,
        harmonics=((3, 0.036, -0.15, 0.178, -1.556),),
    )
    for seed in range(12):
        check(drive.text(seed), {**drive.settings, "frequency": drive.frequency})


def test_a_strong_harmonic_of_a_long_recording_is_one_everywhere():
    """The frequency that the model states holds behind the samples that are checked before all jobs, too."""
    drive = replace(PURE, acceleration=15.0, cycles=1.25 * CHECKED / 32.0, harmonics=((2, 2.4, 0.5, 2.4, 0.9),))
    text = drive.text()
    assert "set model.frequency: 50 if the drive has a strong harmonic" in fault_of(text)
    settings = {**drive.settings, "measured": "mine.csv"}
    check(text, {**settings, "frequency": 50.0})
    assert measure.make(text, settings)["parameters"]["value"][1] == pytest.approx(50.0, abs=1e-3)


def test_a_drive_whose_phase_swings_slowly_is_right():
    """No samples are lost; the swing lowers the amplitude by more than the noise."""
    time, _ = sampled(1600.0)
    swung = time + 0.1 * np.sin(2.0 * np.pi * 1.5 * time / time[-1]) / (2.0 * np.pi * PURE.frequency)
    along, normal = PURE.plate(swung)
    readings = turn(np.array([along, normal]), -PURE.mount) + np.array(PURE.offsets)[:, None]
    readings += 0.02 * np.random.default_rng(1).standard_normal(readings.shape)
    assert_right(estimates(text_of(time, readings)))


@pytest.mark.parametrize("size", [0.002, 0.2])
def test_times_whose_errors_repeat_in_every_cycle_make_no_harmonics(size):
    """Small ones change the residual less than chance: then both even and uneven times count as possible."""
    for seed in range(2):
        drive = replace(PURE, noise=1.0)
        time, readings = drive.record(seed)
        theta = 2.0 * np.pi * PURE.frequency * time
        wrong = time - time[0] + size / (2.0 * np.pi * PURE.frequency) * np.cos(theta + seed)
        assert estimates(text_of(wrong, readings))[2] == []


def test_a_harmonic_is_found_where_its_error_of_the_times_is_possible():
    drive = replace(PURE, harmonics=((2, 0.01, 0.5, 0.01, 1.0),), noise=0.002 * 40.0 * np.sin(0.3), jitter=0.01)
    assert estimates(drive.text(), mount=drive.mount)[2] == [2]


def test_lost_samples_with_the_times_of_the_others_are_right():
    kept = np.arange(len(TIMES)) % 8 != 7
    assert_right(estimates(text_of(TIMES[kept], READINGS[:, kept])))


@pytest.mark.parametrize(("rate", "digits", "lost"), [(400.0, 3, 1), (1600.0, 4, 5)])
@pytest.mark.parametrize("seed", range(3))
def test_few_lost_samples_between_rounded_times_make_no_harmonics(rate, digits, lost, seed):
    """A drive that is nearly locked to the sampling repeats the roundings of its times in each cycle."""
    time, readings = sampled(rate, 1600, frequency=50.01)
    kept = np.ones(len(time), dtype=bool)
    kept[np.random.default_rng(seed).choice(len(time), lost, replace=False)] = False
    found = estimates(text_of(np.round(time, digits)[kept], readings[:, kept], digits=digits))
    values, errors, orders, quality = found
    assert quality["sampling"] == ROUNDED and orders == []
    assert abs(values["acceleration"] - PURE.acceleration) < 3.5 * errors["acceleration"] < 0.2
    assert abs(values["frequency"] - 50.01) < 3.5 * errors["frequency"]


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ("along normal lateral", "the axis normal to the track is ay; set excitation.columns: {time: t, x: ax, z: ay}"),
        ("lateral along normal", "in the column ay, which is not used, with"),
        (
            "turned across normal",
            "the sensor may be turned about its normal by 30°, so that the amplitude would be too",
        ),
        ("along lateral normal", None),
    ],
)
def test_a_third_axis_tells_which_axes_are_right(columns, message):
    drive = replace(PURE, mount=0.0)
    time, (along, normal) = drive.record()
    lateral = 0.02 * (normal - normal.mean()) + np.random.default_rng(1).normal(0.05, 0.1, len(time))
    axes = {"along": along, "normal": normal, "lateral": lateral}
    axes |= {"turned": 0.5 * 3.0**0.5 * along, "across": lateral - 0.5 * along}
    rows = np.array([time, *(axes[name] for name in columns.split())]).T
    text = "\n".join(["t,ax,ay,az", *(",".join(f"{value:.6f}" for value in row) for row in rows), ""])
    if message:
        assert message in fault_of(text, mount=0.0)
    else:
        assert_right(estimates(text, mount=0.0))


@pytest.mark.parametrize("share", [0.12, 0.4])
def test_a_subharmonic_is_not_taken_for_the_drive_unless_the_config_says_so(share):
    drive = Drive(frequency=50.0, acceleration=share * 36.0, harmonics=((2, 1.0 / share, 0.0, 1.0 / share, 0.0),))
    text = text_of(*drive.record(), header="time,along,normal")
    assert "if it vibrates at 100 Hz and every second cycle differs, record the plate without parts" in fault_of(
        text, mount=0.0
    )
    assert "differs in every second cycle" in fault_of(text, mount=0.0, frequency=100.0)
    found = estimates(text, mount=0.0, frequency=50.0)
    assert found[0]["frequency"] == pytest.approx(50.0, abs=1e-2) and found[2] == [2]


@pytest.mark.parametrize("away", [0.7, 0.9, 1.2])
def test_a_line_beside_the_drive_is_part_of_its_errors(away):
    """Where the recording hardly separates both, as hum of the mains beside a drive of nearly its frequency."""
    ratios = []
    for phase in range(4):
        drive = replace(PURE, frequency=49.6, rate=1600.0, cycles=99.2, psi0=1.5 * phase)
        time, readings = drive.record(phase)
        hum = 0.8 * np.cos(2.0 * np.pi * (49.6 + away / 2.0) * time)
        values, errors, *_ = estimates(text_of(time - time[0], readings + np.array([[1.0], [0.3]]) * hum))
        ratios += [abs(values[name] - getattr(drive, name)) / errors[name] for name in values]
    assert max(ratios) < 3.5


def test_steps_of_a_converter_hide_no_harmonic_of_a_drive_that_is_nearly_locked():
    for seed in range(6):
        time, readings = replace(PURE, rate=800.0, frequency=50.0 + 3e-4 * (1 + seed), noise=0.05).record(seed)
        text = text_of(time - time[0], 0.6 * np.round(readings / 0.6))
        settings = {**PURE.settings, "measured": "mine.csv"}
        made = measure.make(text, settings)["harmonics"]
        shares = np.array(made["normal"]) / np.array(made["normal_stderr"])
        assert shares.max() < 3.5


@pytest.mark.parametrize("rate", [400.0, 500.0, 600.0])
def test_harmonics_at_few_locked_phases_are_no_cut_off_peaks(rate):
    random = np.random.default_rng(4)
    for _ in range(12):
        angles = random.uniform(-3.0, 3.0, 4)
        harmonics = ((2, 0.05, angles[0], 0.06, angles[1]), (3, 0.03, angles[2], 0.04, angles[3]))
        drive = replace(PURE, rate=rate, harmonics=harmonics, psi0=random.uniform(0.0, 6.0))
        try:
            check(text_of(*drive.record()), PURE.settings)
        except TableError as error:
            # Order 3 at 8 samples in a cycle changes its sign from sample to sample.
            assert "or the drive has a harmonic of order" in str(error)


def test_lines_of_settings_with_numbers_may_precede_the_header():
    before = "Channel,1,2\nRange,16,16\nOffset,0,0\n"
    assert_right(estimates(before + text_of(TIMES, READINGS)))


def test_empty_rows_at_the_end_do_not_count():
    assert_right(estimates(text_of(TIMES, READINGS) + ",,\n,,\n"))


@pytest.mark.parametrize("runs", [2, 3])
def test_another_run_in_a_file_is_not_to_be_sorted(runs):
    fault = fault_of(text_of(np.tile(TIMES, runs), np.tile(READINGS, runs)))
    assert fault.startswith("mine.csv:3202: ") and "\n" not in fault
    assert "another run, or an overflow of the clock, begins there" in fault and "sort" not in fault


def test_times_that_overflow_again_and_again_are_not_to_be_sorted():
    """Microseconds in 16 bits."""
    text = text_of(1e6 * TIMES % 2**16, READINGS, header="time (µs),x,z", digits=0)
    assert "begins there; keep the lines of one run, or state excitation.rate" in fault_of(text)
    assert_right(estimates(text, rate=PURE.rate))


def test_buffers_in_the_wrong_order_are_to_be_sorted():
    order = np.arange(len(TIMES)).reshape(-1, 16)
    order[[10, 11]] = order[[11, 10]]
    text = text_of(TIMES[order.ravel()], READINGS[:, order.ravel()])
    assert "earlier than the line before; sort the lines" in fault_of(text)


def test_a_last_line_with_too_many_values_is_not_called_incomplete():
    text = text_of(TIMES, READINGS) + "2.0,1,5,9,8\n"
    assert "has 5 values for 3 columns; leave no field out" in fault_of(text)


def test_a_unit_behind_a_name_counts():
    text = text_of(TIMES, READINGS / STANDARD_GRAVITY, header="time,accel_x_g,accel_z_g")
    found = check(text, {"mount": PURE.mount, "columns": {"x": "accel_x_g", "z": "accel_z_g"}})
    assert found.unit == "g"


def test_minutes_behind_a_name_are_refused():
    """The drive of 50 Hz would be one of 3000 Hz, and a drive of 15 Hz one of 900 Hz, which a conveyor may have."""
    text = text_of(TIMES / 60.0, READINGS, header="time_min,x,z", digits=9)
    assert "states times in min" in fault_of(text, columns={"time": "time_min"})


def test_points_between_thousands_beside_decimal_commas():
    lines = [f"{t:.6f};{1e3 * x:,.0f};{1e3 * z:,.0f}" for t, (x, z) in zip(TIMES, READINGS.T / 9.80665, strict=True)]
    text = "\n".join(["time;x (mg);z (mg)", *lines, ""]).replace(".", "!").replace(",", ".").replace("!", ",")
    assert_right(estimates(text, unit="mg"))


@pytest.mark.parametrize("ratio", [0.7, 0.9])
@pytest.mark.parametrize("rate", [400.0, 1600.0, 1730.0])
def test_two_sensors_in_one_file_are_refused(ratio, rate):
    time, readings = sampled(rate)
    mean = readings.mean(axis=1, keepdims=True)
    mixed = np.where(np.arange(len(time)) % 2 == 0, readings, ratio * (readings - mean) + mean)
    assert "as two sensors in one file do" in fault_of(text_of(time, mixed))


ORDERS_OF_SENSORS = {
    "first second second": lambda count: np.arange(count) % 3 == 0,
    "four and four": lambda count: np.arange(count) // 4 % 2 == 0,
    "at random": lambda count: np.random.default_rng(5).random(count) < 0.5,
    "one after the other": lambda count: np.arange(count) < 0.4 * count,
}


@pytest.mark.parametrize("order", ORDERS_OF_SENSORS)
@pytest.mark.parametrize("ratio", [0.8, 1.21])
def test_two_sensors_in_any_order_are_not_called_a_wrong_unit(order, ratio):
    """The mean of both is up to 1.1 times gravity."""
    time, readings = sampled(1730.0)
    mixed = np.where(ORDERS_OF_SENSORS[order](len(time)), readings, ratio * readings)
    fault = fault_of(text_of(time, mixed))
    assert (
        "two sensors in one file" in fault or "where the lines of another sensor, or of another mount, begin" in fault
    )
    assert "gravity," not in fault


def test_an_amplitude_that_changes_at_once_is_no_other_sensor():
    """Gravity stays as it is."""
    time, readings = sampled(1730.0)
    mean = readings.mean(axis=1, keepdims=True)
    stepped = np.where(np.arange(len(time)) < 1000, readings, 1.05 * (readings - mean) + mean)
    check(text_of(time, stepped), PURE.settings)


@pytest.mark.parametrize("share", [0.02, 0.05, 0.09])
@pytest.mark.parametrize("cycles", [10.0, 19.0])
def test_random_losses_in_short_recordings_are_refused_or_part_of_the_error_of_the_frequency(cycles, share):
    outside = 0
    for seed in range(4):
        time, readings = replace(PURE, noise=0.03, cycles=cycles, rate=833.0).record(seed)
        kept = np.random.default_rng(seed).random(len(time)) > share
        try:
            values, errors, _, _ = estimates(text_of(time[: kept.sum()] - time[0], readings[:, kept]))
        except TableError as error:
            assert re.search("lost|swings|not steady", str(error))
        else:
            outside += abs(values["frequency"] - PURE.frequency) > 1.96 * errors["frequency"]
    assert outside <= 1


def test_a_line_without_a_reading_is_not_to_be_deleted_where_lines_are_counted():
    lines = text_of(TIMES, READINGS).splitlines()
    lines[50] = lines[50].split(",")[0] + ",NaN,"
    text = "\n".join(lines)
    assert "x = 'NaN' is not a measured number; delete the line" in fault_of(text)
    fault = fault_of(text, rate=PURE.rate)
    assert fault.count("keep a piece of the file without such lines, because excitation.rate counts") == 2
    assert "delete" not in fault


@pytest.mark.parametrize("twice", [len(TIMES), 200])
@pytest.mark.parametrize("stated", [{}, {"frequency": PURE.frequency}])
def test_a_rate_that_may_count_repeated_lines_is_refused_with_what_to_do(twice, stated):
    again = np.random.default_rng(3).choice(len(TIMES), twice, replace=False)
    lines = np.sort(np.concatenate([np.arange(len(TIMES)), again]))
    text, without = (
        "\n".join(["x,z", *(f"{x:.4f},{z:.4f}" for x, z in READINGS[:, kept].T)])
        for kept in (lines, np.arange(len(TIMES)))
    )
    fault = fault_of(text, rate=PURE.rate, **stated)
    assert f"in {twice:,} lines; if excitation.rate = 1600 is the rate of the sensor, delete these lines" in fault
    frequency = float(re.search(r"counts all lines, state model.frequency: ([\d.]+)", fault)[1])
    assert frequency == pytest.approx(PURE.frequency * len(TIMES) / len(lines), rel=2e-3)
    estimates(text, rate=PURE.rate, frequency=frequency)
    assert_right(estimates(without, rate=PURE.rate))


def test_times_too_coarse_for_the_rate_are_refused_and_a_rate_replaces_them():
    text = text_of(np.floor(TIMES), READINGS, digits=0)
    assert "state excitation.rate (Hz)" in fault_of(text)
    assert_right(estimates(text, rate=PURE.rate))


@pytest.mark.parametrize(("acceleration", "step", "noise"), [(8.0, 1.88, 0.02), (8.0, 1.88, 0.3), (4.0, 0.94, 0.02)])
def test_steps_that_are_too_coarse_are_named(acceleration, step, noise):
    """Samples seemed to be lost, or the angle of throw was wrong by a third."""
    time, readings = sampled(1613.0, acceleration=acceleration, noise=noise, mount=0.0)
    stepped = step * np.round(readings / step)
    assert "different values in the column z; record again with a finer resolution" in fault_of(
        text_of(time, stepped), mount=0.0
    )


def test_noise_makes_coarse_steps_finer():
    time, readings = sampled(1613.0, acceleration=4.0, noise=0.3, mount=0.0)
    values, errors, _, _ = estimates(text_of(time, 0.94 * np.round(readings / 0.94)), mount=0.0)
    assert abs(values["angle"] - PURE.angle) < 3.0 * errors["angle"] < 0.03


@pytest.mark.filterwarnings("error")
def test_one_time_for_all_lines_is_refused_without_warnings():
    """A spreadsheet shortens milliseconds since 1970."""
    lines = [f"1.77260E+12,{x:.4f},{z:.4f}" for x, z in READINGS.T]
    fault = fault_of("\n".join(["timestamp,x,z", *lines, ""]), time_unit="ms")
    assert "and 3,198 further lines repeat the time of the line before" in fault


@pytest.mark.parametrize(
    ("rate", "count", "limit"),
    [
        *((1730.0, 3200, limit) for limit in (0.7, 0.9, 0.95)),
        *((rate, count, 0.9) for rate, count in ((730.0, 131), (730.0, 262), (913.0, 164), (1130.0, 271))),
    ],
)
def test_peaks_that_are_cut_off_before_some_noise_are_refused(rate, count, limit):
    """As by a sensor that saturates before its filter. Short recordings have so few phases that the readings near the
    extremes do not show it, but the wave between them does."""
    time, readings = sampled(rate, count=count)
    readings[0] = np.minimum(readings[0], limit * readings[0].max())
    readings += 3e-4 * readings.max() * np.random.default_rng(2).standard_normal(readings.shape)
    assert "cut-off peaks in the column x" in fault_of(text_of(time, readings))


# Factors of x and z, settings, and what the message must say.
DIRECTIONS = {
    "all negated": (-1, -1, {}, 'excitation.columns: {time: time, x: "-x", z: "-z"}'),
    "underside": (1, -1, {}, 'excitation.columns: {time: time, x: x, z: "-z"}'),
    "x negated": (-1, 1, {}, 'excitation.columns: {time: time, x: "-x", z: z}'),
    "no mount": (1, 1, {"mount": 0.0}, "set excitation.mount: 0.2"),
    "mount in degrees": (1, 1, {"mount": float(np.degrees(0.2) / 4.0)}, "excitation.mount: 0.2"),
    "wrong inclination": (1, 1, {"inclination": 0.1}, "model.inclination: 0"),
}


@pytest.mark.parametrize("name", DIRECTIONS)
def test_axes_that_contradict_gravity_are_refused_with_what_fits(name):
    x, z, settings, message = DIRECTIONS[name]
    assert message in fault_of(text_of(TIMES, READINGS * [[x], [z]]), **settings)


def test_a_mount_in_degrees_is_called_so():
    time, readings = sampled(1600.0, mount=np.radians(3.0))
    fault = fault_of(text_of(time, readings), mount=3.0)
    assert "the mount looks like degrees: set excitation.mount: 0.05236" in fault


def test_exchanged_axes_are_refused_with_their_names():
    time, readings = sampled(1600.0, mount=0.0)
    assert "excitation.columns: {time: time, x: z, z: x}" in fault_of(text_of(time, readings[::-1]), mount=0.0)


def test_columns_with_a_minus_are_right():
    found = estimates(text_of(TIMES, -READINGS), columns={"time": "time", "x": "-x", "z": "-z"})
    assert_right(found)


@pytest.mark.parametrize(
    ("factor", "settings", "message"),
    [
        (256.0 / STANDARD_GRAVITY, {}, "counts, 256 for each g"),
        (420.0 / STANDARD_GRAVITY, {}, "one g is 420"),
        (100.0, {}, "cm/s²"),
        (1.0 / STANDARD_GRAVITY, {}, "set excitation.unit: g"),
        (1000.0, {}, "set excitation.unit: mm/s²"),
        (1000.0 / STANDARD_GRAVITY, {"unit": "g"}, "set excitation.unit: mg"),
        (1.0, {"unit": "g"}, "set excitation.unit: m/s²"),
        (0.1 / STANDARD_GRAVITY, {}, "one g is 0.1"),  # volts of a sensor with 0.1 V for each g
        (0.33 / STANDARD_GRAVITY, {"unit": "g"}, "one g is 0.33"),
    ],
)
def test_means_that_are_not_gravity_are_refused_with_the_unit_or_factor(factor, settings, message):
    settings = {"unit": "m/s²", **settings}
    assert message in fault_of(text_of(TIMES, factor * READINGS), **settings)


def test_an_error_of_the_mount_below_the_noise_of_gravity_is_part_of_the_standard_errors():
    """The mean of the noise may hide 0.8°, so no mount is more exact than that."""
    for seed in range(8):
        drive = replace(PURE, cycles=60.0, noise=3.0)
        values, errors, _, _ = estimates(drive.text(seed), mount=PURE.mount - np.radians(0.8))
        assert abs(values["angle"] - PURE.angle) < 1.96 * errors["angle"]


def test_an_error_of_the_scale_below_the_noise_of_gravity_is_part_of_the_standard_errors():
    for seed in range(8):
        drive = replace(PURE, cycles=60.0, noise=3.0)
        time, readings = drive.record(seed)
        values, errors, _, _ = estimates(text_of(time - time[0], 1.015 * readings))
        assert abs(values["acceleration"] - PURE.acceleration) < 1.96 * errors["acceleration"]


def test_a_wrong_mount_moves_no_harmonic_to_the_other_axis():
    drive = replace(PURE, harmonics=((3, 0.1, 0.4, 0.0, 0.0),), noise=0.01)
    text, settings = drive.text(), {"mount": PURE.mount + np.radians(1.0), "measured": "mine.csv"}
    check(text, {**PURE.settings, **settings})
    harmonics = measure.make(text, {**PURE.settings, **settings})["harmonics"]
    assert [
        order for order, above in zip(harmonics["order"], harmonics["along_above_noise"], strict=True) if above
    ] == [3]
    assert not any(harmonics["normal_above_noise"])


@pytest.mark.parametrize(("unit", "scale"), [("ms", 1e3), ("µs", 1e6), ("ns", 1e9)])
def test_times_without_their_unit_are_refused_with_the_one_that_fits(unit, scale):
    assert f"set excitation.time_unit: {unit} if" in fault_of(text_of(scale * TIMES, READINGS, digits=4))


def test_metres_that_are_stated_as_milligravities_are_refused():
    assert "its values are in m/s²: set excitation.unit: m/s²" in fault_of(text_of(TIMES, READINGS), unit="mg")


def test_a_small_error_of_the_mount_is_part_of_the_standard_errors():
    time, readings = sampled(1600.0, mount=0.23)
    values, errors, _, quality = estimates(text_of(time, readings))
    assert quality["lean"] == pytest.approx(0.03, abs=1e-3)
    assert abs(values["angle"] - PURE.angle) < 1.96 * errors["angle"] < 0.07


def test_a_sensor_that_removes_gravity_is_accepted_and_the_table_says_so():
    _, _, _, quality = estimates(text_of(TIMES, READINGS - READINGS.mean(axis=1, keepdims=True)))
    assert not quality["gravity_found"]


def test_a_mean_in_a_wrong_unit_is_not_taken_for_gravity():
    """An offset of 6 mm/s² is 0.6 g if it is read in m/s²."""
    readings = 1000.0 * (READINGS - READINGS.mean(axis=1, keepdims=True)) + 6.0
    assert fault_of(text_of(TIMES, readings)).count("mine.csv") == 1


SPELLINGS = {
    "lines before": lambda lines: ["Logger v2", "Sample rate,1600", "", *lines],
    "units below": lambda lines: [lines[0], "(s),(m/s^2),(m/s^2)", *lines[1:]],
    "units above": lambda lines: ["Time (s),x [m/s²],z [m/s²]", *lines[1:]],
    "phyphox": lambda lines: ['"Time (s)","Acceleration x (m/s^2)","Acceleration z (m/s^2)"', *lines[1:]],
    "comment sign": lambda lines: ["#" + lines[0], *lines[1:]],
    "trailing comma": lambda lines: [line + "," for line in lines],
    "milliseconds": lambda lines: [
        "Time (ms),x,z",
        *(f"{1000.0 * float(line.split(',')[0]):.4f},{line.split(',', 1)[1]}" for line in lines[1:]),
    ],
    "clock": lambda lines: [lines[0], *(clock(line, "23:59:{:09.6f}", "00:00:{:09.6f}") for line in lines[1:])],
    "dates": lambda lines: [
        lines[0],
        *(clock(line, "2026-02-28T23:59:{:09.6f}Z", "2026-03-01T00:00:{:09.6f}Z") for line in lines[1:]),
    ],
    "settings before": lambda lines: ["Gain,1,1,1", *lines],
    "spaces and units": lambda lines: [
        "Time (s)  x (m/s²)  z (m/s²)",
        *(line.replace(",", "  ") for line in lines[1:]),
    ],
    "two empty columns": lambda lines: [line + ",," for line in lines],
    "minus of typesetters": lambda lines: [line.replace("-", "\u2212") for line in lines],
    "past the hour": lambda lines: [lines[0], *(clock(line, "59:{:09.6f}", "00:{:09.6f}") for line in lines[1:])],
    "milliseconds behind a colon": lambda lines: [
        lines[0],
        *(clock(line, "12:30:{:09.6f}", "12:31:{:09.6f}").replace(".", ":", 1) for line in lines[1:]),
    ],
    "morning and afternoon": lambda lines: [
        "time (hh:mm:ss),x,z",
        *(clock(line, "11:59:{:09.6f} AM", "12:00:{:09.6f} PM") for line in lines[1:]),
    ],
    "German dates": lambda lines: [
        lines[0],
        *(clock(line, "28.02.2026 23:59:{:09.6f}", "01.03.2026 00:00:{:09.6f}") for line in lines[1:]),
    ],
    "names of months": lambda lines: [
        lines[0],
        *(clock(line, "28-Feb-2026 23:59:{:09.6f}", "01-Mar-2026 00:00:{:09.6f}") for line in lines[1:]),
    ],
    "name of the time zone": lambda lines: [
        lines[0],
        *(clock(line, "28 Feb 2026 23:59:{:09.6f} UTC", "1 Mar 2026 00:00:{:09.6f} UTC") for line in lines[1:]),
    ],
    "hours of the time zone": lambda lines: [
        lines[0],
        *(clock(line, "2026-03-29 01:59:{:09.6f}+01", "2026-03-29 03:00:{:09.6f}+02") for line in lines[1:]),
    ],
    "comment on the first line": lambda lines: [
        lines[0] + ",Comment",
        lines[1] + ",first",
        *lines[2:],
    ],
    "tabs and names of several words": lambda lines: [
        "Time (s)\tAcceleration X (m/s^2)\tAcceleration Z (m/s^2)",
        *(line.replace(",", "\t") for line in lines[1:]),
    ],
    "commas and spaces": lambda lines: [
        "Time (s), X (m/s^2), Z (m/s^2)",
        *(line.replace(",", ", ") for line in lines[1:]),
    ],
    "commas and tabs": lambda lines: [line.replace(",", ",\t") for line in lines],
    "tabs, names of several words, and a tab at the end": lambda lines: [
        "Time (s)\tAcceleration X (m/s^2)\tAcceleration Z (m/s^2)\t",
        *(f"{line}\t".replace(",", "\t") for line in lines[1:]),
    ],
    "beginning of daylight saving": lambda lines: [
        lines[0],
        *(clock(line, "2026-03-29T01:59:{:09.6f}+01:00", "2026-03-29T03:00:{:09.6f}+02:00") for line in lines[1:]),
    ],
    "settings for each channel": lambda lines: [
        "Channels\t2\t",
        "X_Dimension\tTime\tTime",
        "X0\t0.0\t0.0",
        "Delta_X\t0.000625\t0.000625",
        "time\tx\tz",
        *(line.replace(",", "\t") for line in lines[1:]),
    ],
    "nanoseconds": lambda lines: [
        "timestamp (ns),x,z",
        *(
            f"{1714567890123456789 + round(1e9 * float(line.split(',')[0]))},{line.split(',', 1)[1]}"
            for line in lines[1:]
        ),
    ],
}


def clock(line, before, after):
    """A line with a clock time that passes midnight after a second."""
    time, rest = line.split(",", 1)
    second = 59.0 + float(time)
    return f"{before.format(second) if second < 60.0 else after.format(second - 60.0)},{rest}"


@pytest.fixture(scope="module")
def plain():
    """The lines of a file without peculiarities, and its recording."""
    text = text_of(TIMES, READINGS)
    return text.splitlines(), check(text, {"mount": PURE.mount})


@pytest.mark.parametrize("name", SPELLINGS)
def test_files_are_read_as_loggers_write_them(name, plain):
    lines, expected = plain
    found = check("\n".join([*SPELLINGS[name](lines), ""]), {"mount": PURE.mount})
    np.testing.assert_allclose(found.acceleration, expected.acceleration, atol=1e-9)
    np.testing.assert_allclose(found.time, expected.time, atol=2e-6)


def test_columns_without_names_are_called_by_number():
    text = text_of(TIMES, READINGS)
    expected, bare = check(text, PURE.settings), text.split("\n", 1)[1]
    columns = {"time": "1", "x": "2", "z": "3"}
    for found in (
        check(bare, {**PURE.settings, "columns": columns}),
        check(bare.replace(",", ";").replace(".", ","), {**PURE.settings, "columns": columns}),
    ):
        np.testing.assert_array_equal(found.readings, expected.readings)
        np.testing.assert_array_equal(found.time, expected.time)
    assert 'excitation.columns names them by number, such as {time: "1", x: "2", z: "3"}' in fault_of(bare)


def test_a_column_that_could_be_another_is_refused():
    """Where x is a position, and accel_x an acceleration."""
    text = text_of(TIMES, READINGS, header="time,accel_x,accel_z").replace("\n", ",0.1\n").replace("z,0.1", "z,x", 1)
    assert "has the columns accel_x and x; say which one is x in excitation.columns" in fault_of(text)


@pytest.mark.parametrize("change", [lambda one: one.replace(",", "|"), lambda one: one.replace(".", "D")])
def test_a_file_without_a_line_of_numbers_is_refused_once(change):
    assert "has no line with two numbers; separate columns by" in fault_of(change(text_of(TIMES, READINGS)))


def test_recordings_a_day_apart_are_no_recording():
    lines = text_of(TIMES, READINGS).splitlines()
    days = [clock(line, "2026-03-01T10:00:{:09.6f}", "2026-03-03T10:01:{:09.6f}") for line in lines[1:]]
    assert "follows a gap" in fault_of("\n".join([lines[0], *days, ""]))


def test_thousands_have_separators():
    rows = [f"{t:.6f};{1000.0 * x:,.1f};{1000.0 * z:,.1f}" for t, (x, z) in zip(TIMES, READINGS.T, strict=True)]
    english = "\n".join(["time;x;z", *rows, ""])
    for text in (english, english.translate(str.maketrans(",.", ".,"))):
        found = check(text, {"mount": PURE.mount, "unit": "mm/s²"})
        np.testing.assert_allclose(found.readings, READINGS, atol=6e-5)


def test_many_whole_numbers_with_and_without_commas_have_thousands():
    rows = [f"{t:.0f};{x:,.0f};{z:,.0f}" for t, (x, z) in zip(1e6 * TIMES, READINGS.T / UNITS["mg"], strict=True)]
    found = check("\n".join(["time;x;z", *rows, ""]), {"mount": PURE.mount, "unit": "mg", "time_unit": "µs"})
    np.testing.assert_allclose(found.readings, READINGS, atol=6e-3)


@pytest.mark.parametrize(("header", "unit"), [("time", 1.0), ("time", 1e-3), ("time (ms)", 1e-3), ("t", 1e-6)])
def test_a_rate_that_contradicts_the_times_of_the_file_is_refused(header, unit):
    text = text_of(TIMES / unit, READINGS, header=f"{header},x,z")
    rate = (len(TIMES) - 1) / np.ptp(TIMES)
    found = check(text, {**PURE.settings, "rate": 1.0005 * rate})
    assert found.sampling == "rate"
    with pytest.raises(TableError, match="correct the rate"):
        check(text, {**PURE.settings, "rate": 1.005 * rate})
    with pytest.raises(TableError) as error:
        check(text, {**PURE.settings, "rate": 0.5 * rate})
    assert f"with {rate:.6g} samples per second, but excitation.rate is {0.5 * rate:g}" in str(error.value)


def test_compressed_files_and_other_encodings_are_read(tmp_path):
    text = text_of(TIMES, READINGS, header="time (s),x (m/s²),z (m/s²)")
    for name, content in {
        "mine.csv.gz": gzip.compress(text.encode()),
        "latin.csv": text.encode("latin-1"),
        "wide.csv": text.encode("utf-16"),
    }.items():
        (tmp_path / name).write_bytes(content)
        assert read_text(tmp_path / name, "excitation.measured", MOST_BYTES) == text


def test_missing_columns_are_named_once_with_the_key():
    text = text_of(TIMES, READINGS, header="Stamp,ch 1,ch 2")
    with pytest.raises(TableError) as error:
        check(text, PURE.settings)
    assert len(error.value.faults) == 1
    assert 'there are Stamp, "ch 1", "ch 2". Say which is which by excitation.columns' in str(error.value)
    columns = {"time": "Stamp", "x": "ch 1", "z": "ch 2"}
    assert check(text, {**PURE.settings, "columns": columns}).names == columns


def test_names_decide_what_a_column_is_and_its_unit():
    text = text_of(1e6 * TIMES, READINGS, header="clk,a1,a2", digits=1)
    settings = {**PURE.settings, "columns": {"time": "clk", "x": "a1", "z": "a2"}, "time_unit": "µs"}
    np.testing.assert_allclose(resolve(check(text, settings)).time, TIMES, atol=1e-7)


def load(tmp_path, text, **overlay):
    (tmp_path / "mine.csv").write_text(text)
    overlay = {"prefix": "mine", **overlay, "excitation": {"measured": "mine.csv", **overlay.get("excitation", {})}}
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(overlay, allow_unicode=True))
    return load_config([file], read(file)).config


def test_a_frequency_that_contradicts_the_overlay_is_refused(tmp_path):
    time, readings = sampled(1600.0, frequency=55.0)
    text, excitation = text_of(time, readings), {"mount": PURE.mount}
    with pytest.raises(ConfigError, match=r"vibrates at 55 Hz, but model.frequency is 50"):
        load(tmp_path, text, excitation=excitation, model={"frequency": 50.0})
    with pytest.raises(ConfigError, match=r"vibrates at 55 Hz, but model.frequency is 60"):
        load(tmp_path, text, excitation=excitation, model={"frequency": 60.0})
    load(tmp_path, text, excitation=excitation, model={"frequency": 54.8})
    # Nobody has stated the default.
    load(tmp_path, text, excitation=excitation)


def test_a_table_knows_its_lines():
    text = "\n# note\n" + text_of(TIMES, READINGS)
    assert table_of(text, PURE.settings).lines[:2].tolist() == [4, 5]


@pytest.mark.parametrize(
    "header",
    [
        "time,x,z\n#s,g,g",
        "#s,g,g\ntime,x,z",
        "time,x,z\ns,g,g",
        "time,x,z\nSeconds,G,G",
        "t/s,x/g,z/g",
        "t / s,x / g,z / g",
        "time (s),x <g>,z {g}",
        "time (Sec),x [G],z (g)",
    ],
)
def test_the_unit_of_a_header_counts(header):
    found = check(text_of(TIMES, READINGS / STANDARD_GRAVITY, header=header), {"mount": PURE.mount})
    assert (found.unit, found.time_unit) == ("g", "s")
    np.testing.assert_allclose(found.readings, READINGS, atol=1e-3)


def test_a_unit_line_may_state_further_units():
    rows = text_of(TIMES, READINGS / STANDARD_GRAVITY, header="").splitlines()[1:]
    text = "\n".join(["time,x,z,temperature", "s,g,g,°C", *(f"{row},25" for row in rows), ""])
    assert check(text, {"mount": PURE.mount}).unit == "g"


def test_gravity_on_an_axis_that_is_not_used_is_refused_also_if_the_columns_are_stated():
    time, (along, normal) = replace(PURE, mount=0.0).record()
    rows = np.array([time, along, np.zeros(len(time)), normal]).T
    text = "\n".join(["t,ax,ay,az", *(",".join(f"{value:.6f}" for value in row) for row in rows), ""])
    fault = fault_of(text, mount=0.0, columns={"time": "t", "x": "ax", "z": "ay"})
    assert "has gravity in the column az, which is not used" in fault


def test_a_comment_above_the_header_that_looks_like_a_unit_is_a_comment():
    assert check("# g\n" + text_of(TIMES, READINGS), {"mount": PURE.mount}).unit == "m/s²"


def test_one_column_for_both_axes_is_refused():
    fault = fault_of(text_of(TIMES, READINGS), columns={"time": "time", "x": "x", "z": "x"})
    assert "has one column 'x' for both x and z in excitation.columns" in fault


def test_a_last_line_without_its_end_is_named():
    text = text_of(TIMES, READINGS).rstrip("\n").rpartition(",")[0]
    assert "delete the line, the last one, which may be incomplete" in fault_of(text)


def test_a_recording_without_noise_is_no_error():
    time = np.arange(800) / 2000.0
    wave = np.cos(2.0 * np.pi * 50.0 * time)
    text = "\n".join(
        [
            "time,along,normal",
            *(f"{t!r},{36 * w!r},{8 * w + 9.81!r}" for t, w in zip(time.tolist(), wave.tolist(), strict=True)),
            "",
        ]
    )
    assert check(text, {"mount": 0.0}).unit == "m/s²"


@pytest.mark.parametrize(("rate", "every"), [(1000.0, 10), (800.0, 8), (3200.0, 16), (3200.0, 64)])
@pytest.mark.parametrize("second", [0.0, 0.1])
def test_losses_in_step_with_the_drive_are_no_harmonics(rate, every, second):
    """One of every few samples is lost, and the lines are numbered."""
    harmonics = ((2, second, 1.0, second, 0.4),) if second else ()
    time, readings = sampled(rate, harmonics=harmonics)
    kept = np.arange(len(time)) % every != 3
    fault = fault_of(text_of(time[: kept.sum()], readings[:, kept]))
    assert f"f one of {every} samples is lost" in fault and "the drive vibrates at 50 Hz" in fault


def test_two_sensors_whose_noise_hides_their_difference_are_told_by_its_spread():
    time, readings = sampled(1613.7, noise=1.0)
    is_second = np.random.default_rng(3).random(len(time)) < 0.5
    mixed = np.where(is_second, 0.85, 1.0) * readings
    assert "% (standard deviation), and phases that do not, as two sensors in one file do" in fault_of(
        text_of(time, mixed)
    )


# The last four rates are little above twice the frequency of the harmonic.
@pytest.mark.parametrize(
    ("rate", "order"), [(1613.7, 9), (1600.0, 10), (850.0, 8), (870.0, 8), (950.0, 9), (1130.0, 11)]
)
def test_a_weak_harmonic_of_high_order_is_no_second_sensor_and_cuts_nothing_off(rate, order):
    time, readings = sampled(rate, harmonics=((order, 0.03, 0.5, 0.03, 1.0),))
    found = estimates(text_of(time, readings))
    assert order in found[2]


@pytest.mark.parametrize(("seconds", "ppm"), [(2.0, 300.0), (10.0, 100.0), (10.0, 300.0), (30.0, 50.0), (60.0, 20.0)])
def test_axes_of_two_loggers_are_refused(seconds, ppm):
    """The clock of the second axis is faster."""
    drive = replace(PURE, mount=0.0, cycles=50.0 * seconds, rate=1000.0)
    time, readings = drive.record()
    readings[1] += drive.plate(time * (1.0 + 1e-6 * ppm))[1] - drive.plate(time)[1]
    fault = fault_of(text_of(time, readings, header="time,along,normal"), mount=0.0)
    assert "has a phase between both axes that drifts" in fault
    assert float(re.search(r"differ by (\S+) ppm measured", fault)[1]) == pytest.approx(ppm, rel=0.15)


def test_lines_in_reverse_order_are_refused_with_and_without_a_rate():
    text = text_of(TIMES[::-1], READINGS[:, ::-1])
    assert "the last lines come first; reverse their order" in fault_of(text)
    fault = fault_of(text, rate=1600.0)
    assert "the last lines come first; reverse their order" in fault
    assert "has times that go back in line 3, which excitation.rate would ignore" in fault
    coarse = text_of(np.round(TIMES[::-1], 2), READINGS[:, ::-1])
    assert "reverse their order" in fault_of(coarse) and "reverse their order" in fault_of(coarse, rate=1600.0)


@pytest.mark.parametrize(("header", "noise"), [("T,x,z", 1.0), ("T (°C),x,z", 0.0)])
def test_a_temperature_is_no_time_beside_a_rate(header, noise):
    """One with noise, or one that falls all the time and has its unit."""
    temperature = 20.0 + noise * np.random.default_rng(2).normal(size=len(TIMES)) - TIMES
    assert check(text_of(temperature, READINGS, header=header), {**PURE.settings, "rate": 1600.0}).sampling == "rate"


def test_a_clock_that_overflows_is_counted_on_with_a_rate():
    overflowing = np.floor(1e3 * TIMES + 65000.0) % 65536.0
    text = text_of(overflowing, READINGS, header="time (ms),x,z", digits=0)
    assert check(text, {**PURE.settings, "rate": 1600.0}).sampling == "rate"


def test_a_time_that_is_late_near_the_beginning_is_no_second_run_beside_a_rate():
    late = TIMES.copy()
    late[1:3] = 2.5 * TIMES[1], 1.5 * TIMES[1]
    assert check(text_of(late, READINGS), {**PURE.settings, "rate": 1600.0}).sampling == "rate"


def test_a_small_drift_between_the_axes_is_part_of_the_error():
    drive = replace(PURE, mount=0.0, cycles=500.0)
    time, readings = drive.record()
    readings[1] += drive.plate(time * (1.0 + 3e-5))[1] - drive.plate(time)[1]
    values, errors, _, quality = estimates(text_of(time, readings, header="time,along,normal"), mount=0.0)
    assert abs(values["phase_shift"] - drive.phase_shift) < 2.1 * errors["phase_shift"]
    assert abs(quality["between_axes"]) == pytest.approx(2.0 * np.pi * 500.0 * 3e-5, rel=0.1)


def test_a_second_run_is_refused_also_with_a_rate():
    text = text_of(np.tile(TIMES, 2), np.tile(READINGS, 2))
    assert "another run" in fault_of(text) and "another run" in fault_of(text, rate=1600.0)


@pytest.mark.parametrize(("name", "stated"), [("angle", 0.6), ("phase_shift", -0.2), ("phase_shift", 3.0)])
def test_a_stated_direction_that_contradicts_the_recording_is_refused(name, stated):
    text = text_of(TIMES, READINGS)
    fault = fault_of(text, **{name: stated})
    words = name.replace("_", " ")
    measured = float(re.search(rf"has the {words} (\S+) rad", fault)[1])
    assert measured == pytest.approx(getattr(PURE, name), abs=0.01)
    assert f"model.{name} is {stated:.4g} rad" in fault
    check(text, {**PURE.settings, "angle": 0.33, "phase_shift": 0.25})


def test_twice_the_stated_frequency_is_that_of_a_magnet_at_the_mains():
    assert "a magnet pulls twice in each cycle of the mains" in fault_of(PURE.text(), frequency=25.0)


def test_times_in_days_are_named():
    assert "its times may be in days; export" in fault_of(text_of(TIMES / 86400.0, READINGS, digits=14))
    assert "its times may be in hours" in fault_of(text_of(TIMES / 3600.0, READINGS, digits=14))


def test_no_mount_is_proposed_in_more_digits_than_gravity_shows():
    drive = replace(PURE, mount=0.0, noise=0.0)
    text = text_of(*drive.record(), header="time,x,z")
    assert "set excitation.mount: 0 if" in fault_of(text, mount=0.1)


@pytest.mark.parametrize("degrees", [5.0, 10.0, 15.0])
def test_the_errors_contain_what_the_third_axis_says_of_a_turned_sensor(degrees):
    drive = replace(PURE, mount=0.0)
    time, (along, normal) = drive.record()
    turned = np.radians(degrees)
    rows = np.array([time, along * np.cos(turned), along * np.sin(turned), normal]).T
    text = "\n".join(["time,x,y,z", *(",".join(f"{value:.7f}" for value in row) for row in rows), ""])
    values, errors, _, quality = estimates(text, mount=0.0)
    for name in ("acceleration", "angle"):
        assert abs(values[name] - getattr(drive, name)) < 2.1 * errors[name]
    assert quality["across"] == pytest.approx(np.tan(turned), rel=1e-3)


@pytest.mark.parametrize(("drift", "noise", "colour"), [(0.3, 0.3, 0.99), (0.3, 0.05, 0.5), (0.1, 0.05, 0.99)])
def test_an_amplitude_that_rises_is_no_second_sensor(drift, noise, colour):
    drive = replace(PURE, cycles=400.0, drift=drift, noise=noise, colour=colour)
    assert estimates(drive.text())[3]["drift"] == pytest.approx(drift, rel=0.05)
