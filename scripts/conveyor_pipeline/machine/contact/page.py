"""The contact in words, with all numbers from the tables."""

import math

import numpy as np
import pandas as pd

from conveyor import restitution, throw_number
from conveyor.materials import ELASTOMERS, UNCERTAINTY, material
from conveyor_pipeline.common.templates import render
from conveyor_pipeline.machine.contact.derive import HERTZ, NAMED, drop_speed, moduli_of, on_level_plate
from conveyor_pipeline.machine.contact.variants import BOUNCE, RADIUS, STATED, contacts, penetration, stiffness_range
from conveyor_pipeline.machine.operating.advice import EVEN, FAST
from conveyor_pipeline.machine.operating.chart import CERTAIN

SPEEDS = (0.02, 0.05, 0.1, 0.2, 0.5)  # m/s, in the table of restitutions
NOTICEABLE = 0.2  # relative change of the velocity of the slowest parts that the page points out


def describe(entry: str | dict) -> dict:
    """A material as the page names it; without a source for moduli of the config."""
    if isinstance(entry, str):
        return material(entry)._asdict()
    modulus, poisson = moduli_of(entry)
    labels = {"name": "the config's moduli", "description": "moduli of the config", "source": ""}
    return labels | {"modulus": modulus, "low": modulus, "high": modulus, "poisson": poisson}


def normal_acceleration(acceleration: float, model: dict) -> float:
    """A bound on the acceleration of the plate normal to the track (m/s²); without harmonics, the largest one."""
    largest = throw_number(acceleration, **model) * model["gravity"] * math.cos(model["inclination"])
    return largest * (1.0 + sum(harmonic["normal"] for harmonic in model.get("harmonics", ())))


def make(template: str, variants: pd.DataFrame, advice: pd.DataFrame) -> str:
    """The page from its template, the table of variants and the advice."""
    settings = variants.attrs
    aims = {FAST: "fast for nearly all parts", EVEN: "even"}
    if len(advice) == 2 and advice.acceleration.nunique() == 1:
        advice, variants, aims = advice[:1], variants[variants.aim == advice.aim.iloc[0]], {FAST: "fast and even"}
    contact, model = settings["contact"], settings["model"]
    drop = drop_speed(settings)
    impacts = {row.aim: row.impact_speed for row in advice.itertuples() if row.impact_speed > 0.0}
    places = [(f"in the drop of {1e3 * contact['drop_height']:g} mm", drop)]
    places += [(f"at the advised amplitude, {aim}", speed) for aim, speed in impacts.items()]
    places += [(None, speed) for speed in SPEEDS]
    by_aim = {}
    for aim, rows in variants.groupby("aim", sort=False):
        slowest, stated = rows.velocity_05, rows.velocity_05.iloc[0]
        changes = (slowest / stated - 1.0).abs() if stated else slowest * np.nan
        certain = (slowest - stated).abs() > CERTAIN * np.hypot(
            rows.velocity_05_stderr, rows.velocity_05_stderr.iloc[0]
        )
        changes = changes.where(certain)
        by_aim[aim] = {
            "rows": rows.replace({np.nan: None}).to_dict("records"),
            "slowest": (float(slowest.min()), float(slowest.max())),
            "stated": float(stated),
            "most": rows.variant.loc[changes.idxmax()] if changes.notna().any() else None,
            "change": float(changes.max()),
        }
    depths = {"drop": penetration(model, drop)}
    for row in advice[advice.aim.isin(impacts)].itertuples():
        depths[row.aim] = penetration(model, row.impact_speed, normal_acceleration(row.acceleration, model))
    depth_at_rest = (model["mass"] * model["gravity"] / model["stiffness"]) ** (1.0 / model["exponent"])
    values = {
        "contact": contact,
        "model": model,
        "is_hertz": model["exponent"] == HERTZ,
        "materials": {name: describe(contact[name]) for name in NAMED} if contact.get("radius") is not None else {},
        "stiffness_range": stiffness_range(settings),
        "contacts": contacts(settings),
        "rest": depth_at_rest,
        "depths": depths,
        "restitutions": [
            {"place": place, "speed": speed, "restitution": restitution(on_level_plate(model), speed)}
            for place, speed in sorted(places, key=lambda pair: -pair[1])
        ],
        "by_aim": by_aim,
        "has_errors": variants.velocity_05_stderr.notna().any(),
        "aims": aims,
        "has_elastomer": any(str(contact.get(name)).startswith(ELASTOMERS) for name in NAMED),
        "factors": {"radius": RADIUS, "stated": STATED, "elastomer": UNCERTAINTY},
        "bounce": BOUNCE,
        "noticeable": NOTICEABLE,
        "sqrt": math.sqrt,
    }
    return render(template, values)
