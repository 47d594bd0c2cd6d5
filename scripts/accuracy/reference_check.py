"""Check of the reference of the charts, the solver at its tightest tolerance, with a multiprecision solution."""

import numpy as np

from accuracy import multiprecision
from accuracy.precision import TRUTH, contact_changes, sample_times
from conveyor import simulate
from conveyor.methods import modes
from pipeline import fields, grid

TABLES = {
    "reference_check": (
        fields.text("quantity", "x, vx, z, vz at fixed times, or event for an impact or a separation"),
        fields.number("time", "s", "time; time of an event in the multiprecision solution"),
        fields.number("value", "m, m/s", "value in the multiprecision solution; null for events"),
        fields.number("difference", "1", "from the tightest tolerance, in units of the plate's motion; events: cycles"),
    ),
}

DIGITS = 26  # of the multiprecision arithmetic


def make(settings: dict) -> dict[str, np.ndarray]:
    """The columns of the table, for the settings of a scene.

    Raises
    ------
    RuntimeError
        if both solutions have different numbers of events
    """
    conveyor, start = grid.conveyor_and_start(settings["model"])
    times = sample_times(settings)
    states, events = multiprecision.simulate(conveyor, start, times, DIGITS)
    run = simulate(conveyor, start, duration=settings["duration"], tolerance=TRUTH)
    own = run.sample(times)
    scales = modes.scales(grid.row_of(settings["model"]))
    rows = [
        {"quantity": name, "time": time, "value": value, "difference": (there - value) / scale}
        for name, scale, column in zip(("x", "vx", "z", "vz"), scales, states.T, strict=True)
        for time, value, there in zip(times, column, own[name], strict=True)
    ]
    own_events = contact_changes(run.events)
    own_events = own_events[own_events <= times[-1]]
    if len(own_events) != len(events):
        raise RuntimeError(
            f"the multiprecision solution has {len(events)} impacts and separations, the solver {len(own_events)}; "
            "increase the digits"
        )
    differences = (own_events - events) * conveyor.frequency
    rows += [
        {"quantity": "event", "time": time, "value": np.nan, "difference": difference}
        for time, difference in zip(events, differences, strict=True)
    ]
    return fields.columns(rows, TABLES["reference_check"])
