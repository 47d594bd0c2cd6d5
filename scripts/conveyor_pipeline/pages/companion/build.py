"""The companion: one HTML file that computes the trajectory of a part in the browser, offline."""

import base64
import json
from pathlib import Path

import numpy as np
import pandas as pd

from conveyor import PARAMETERS, RANGES
from conveyor.parameters import LAST, TANGENTIAL
from conveyor_pipeline.common.rule_log import JobError
from conveyor_pipeline.figures import style

HERE = Path(__file__).parent
# Files inserted into page.html, each in place of the comment with its name.
SCRIPTS = ("solver", "shared", "controls", "state_maps", "plots", "scene", "page")
PARTS = ("page.css", *(f"{name}.js" for name in SCRIPTS))
STATES = tuple(style.STATE_COLOURS)
OPENING = "second"  # preset that the page shows first
SEPARATION = 1e-6  # m, by which the second part starts higher
LINE = 0.01  # width of a line in units of a plot's range


def encode(table: pd.DataFrame) -> dict:
    """A state map for the page, from a sweep over two parameters.

    Returns
    -------
    dict
        x, y: name, start, stop (SI units) and number of values of both axes, the phase on y
        model: the parameters that all points share
        states: indices in STATES, row by row along y, in base64; four to a byte, lowest bits first

    Raises
    ------
    JobError
        if the table is not a sweep over two parameters with even steps
    """
    names = list(table.attrs["axes"])
    if len(names) != 2:
        raise JobError(f"a state map needs two axes, but this sweep has {', '.join(names)}; change companion.maps")
    y, x = names if names[0] == "psi0" else reversed(names)
    codes = table.assign(code=table.state.map(STATES.index)).pivot(index=y, columns=x, values="code")
    axes = {}
    for place, name, values in (("x", x, codes.columns.to_numpy()), ("y", y, codes.index.to_numpy())):
        even = np.linspace(values[0], values[-1], len(values))
        if len(values) < 2 or not np.allclose(values, even, rtol=0.0, atol=1e-6 * (even[1] - even[0])):
            raise JobError(f"the values of {name} must be evenly spaced for a map of the interactive page")
        axes[place] = {"name": name, "start": float(values[0]), "stop": float(values[-1]), "num": len(values)}
    bits = np.unpackbits(codes.to_numpy().astype(np.uint8).reshape(-1, 1), axis=1, count=2, bitorder="little")
    packed = np.packbits(bits, bitorder="little")
    model = {name: value for name, value in table.attrs["model"].items() if name not in names}
    return {**axes, "model": model, "states": base64.b64encode(packed.tobytes()).decode()}


def accuracy_text(accuracy: dict) -> str:
    """How far the page is from the library, as tests/pages/test_companion.py measures it in a browser."""
    return (
        f"Tests compare the page with an accurate solution at {accuracy['settings']} random settings of its controls. "
        f"At {accuracy['within_a_line']} settings, the curves of height and velocity differ by less than "
        f"{100 * LINE:g} % of the height of their plots, as long as the page does not mark the motion as unresolved. "
        f"Half of the mean velocities have a relative error below {100 * accuracy['median_velocity_error']:.1g} %."
    )


def make(maps: list[pd.DataFrame], settings: dict) -> str:
    """The whole page.

    maps : sweeps over two parameters, with the column `state`, in the order in which the page offers them
    settings : the config's `model`, `solver` and `companion`

    Raises
    ------
    JobError
        if a table is not a state map, or if the plate's motion has harmonics, which the page does not compute
    ValueError
        if a file cannot be inserted into page.html
    """
    section = settings["companion"]
    models = [settings["model"], *section["presets"].values(), *(table.attrs["model"] for table in maps)]
    if any(model.get("harmonics") for model in models):
        raise JobError("the interactive page draws no harmonics of the plate; leave model.harmonics out to make it")
    data = {
        # The static friction coefficient is null where it equals the friction coefficient.
        "model": {name: settings["model"].get(name) for name in PARAMETERS},
        "ranges": RANGES,
        "tangential": TANGENTIAL,
        "solver": {name: settings["solver"][name] for name in ("duration", "step")},
        "presets": section["presets"],
        "opening": OPENING,
        "separation": SEPARATION,
        "last": LAST,
        "line": LINE,
        "states": STATES,
        "colours": style.STATE_COLOURS,
        "euler": style.EULER,
        "maps": [encode(table) for table in maps],
    }
    text = (HERE / "page.html").read_text(encoding="utf-8")
    parts = {name: (HERE / name).read_text(encoding="utf-8").strip() for name in PARTS}
    # "</" could end the script element; "<\/" is the same in JSON.
    parts["accuracy"] = accuracy_text(json.loads((HERE / "accuracy.json").read_text(encoding="utf-8")))
    parts["data"] = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":")).replace("</", "<\\/")
    for name, part in parts.items():
        mark = f"/* {name} */"
        if text.count(mark) != 1:
            raise ValueError(f"page.html must have one mark {mark}, but has {text.count(mark)}")
        if "</script" in part or "</style" in part:
            raise ValueError(f"{name} contains </script or </style, which would end its own element")
        text = text.replace(mark, part)
    return text
