"""What the uncertainty of a contact changes: the parts of the transit table at the advised amplitudes, on softer and
stiffer contacts, and on such that bounce less and more.

Where the stiffness follows from materials, it is uncertain by the ranges of their moduli and by the radius, which is
rarely known at the place of contact. A stated stiffness is taken as uncertain by a factor. The damping of each variant
belongs to the restitution in the drop, which is read from a bounce. These uncertainties are assumptions.
"""

import math

import numpy as np
import pandas as pd
from scipy.optimize import brentq

from conveyor import damping_of, hertz_stiffness, restitution
from conveyor.materials import material
from conveyor_pipeline.common import fields
from conveyor_pipeline.machine.contact.derive import NAMED, drop_speed, moduli_of, on_level_plate
from conveyor_pipeline.machine.operating.parts import population
from conveyor_pipeline.machine.operating.transit import MEASURES, follow_parts, summarize_populations

RADIUS = 2.0  # factor by which the radius of contact may be larger or smaller
STATED = 2.0  # factor by which a stated stiffness may be larger or smaller
BOUNCE = 0.1  # relative error of the restitution: of the height of the bounce, 20 %
STATED_CONTACT, SOFT, STIFF, DEAD, LIVELY = VARIANTS = ("stated", "softer", "stiffer", "bounces less", "bounces more")
TABLES = {
    "variants": (
        fields.text("variant", f"contact: {', '.join(VARIANTS)}"),
        fields.text("aim", "aim of the advised amplitude, see advice"),
        fields.number("acceleration", "m/s²", "advised amplitude of the excitation"),
        fields.number("stiffness", "N/m^p", "contact stiffness"),
        fields.number("damping", "N s/m", "contact damping"),
        fields.number("drop", "1", "coefficient of restitution in the drop"),
        fields.number("speed", "m/s", "impact speed of the chart at this amplitude; 0 for no impacts"),
        fields.number("restitution", "1", "coefficient of restitution at this speed; null for no impacts"),
        *MEASURES,
    )
}


def stiffness_range(settings: dict) -> tuple[float, float]:
    """Lowest and highest stiffness (N/m^p) that the section `contact` leaves open."""
    section, model = settings["contact"], settings["model"]
    if section.get("radius") is None:
        return model["stiffness"] / STATED, model["stiffness"] * STATED
    ends = []
    for end, radius in (("low", section["radius"] / RADIUS), ("high", section["radius"] * RADIUS)):
        pairs = []
        for name in NAMED:
            entry = moduli_of(section[name])
            named = material(entry) if isinstance(entry, str) else None
            pairs.append((getattr(named, end), named.poisson) if named else entry)
        ends.append(hertz_stiffness(*pairs, radius))
    return ends[0], ends[1]


def contacts(settings: dict) -> dict[str, dict[str, float]]:
    """Stiffness (N/m^p), damping (N s/m) and restitution in the drop (`drop`) of each variant.

    A contact that does not bounce in the drop has no variants of its damping, and none bounces higher than it fell.
    """
    model = settings["model"]
    speed = drop_speed(settings)
    stated = restitution(on_level_plate(model), speed)
    low, high = stiffness_range(settings)

    def contact(stiffness: float, drop: float) -> dict[str, float]:
        damping = model["damping"]
        if stated > 0.0:
            damping = damping_of(drop, speed, on_level_plate(model, stiffness=stiffness)) if drop < 1.0 else 0.0
        return {"stiffness": stiffness, "damping": damping, "drop": drop}

    variants = {
        STATED_CONTACT: {"stiffness": model["stiffness"], "damping": model["damping"], "drop": stated},
        SOFT: contact(low, stated),
        STIFF: contact(high, stated),
    }
    if stated > 0.0:
        variants[DEAD] = contact(model["stiffness"], stated * (1.0 - BOUNCE))
        if stated * (1.0 + BOUNCE) < 1.0:
            variants[LIVELY] = contact(model["stiffness"], stated * (1.0 + BOUNCE))
    return variants


def penetration(model: dict, speed: float, plate: float = 0.0) -> float:
    """Deepest penetration (m) of an impact at a speed (m/s) without damping, which makes it less deep.

    plate : m/s², upwards acceleration of the plate, which presses the part into it as gravity does
    """
    power, mass = model["exponent"] + 1.0, model["mass"]
    pull = mass * (model["gravity"] + plate)

    def excess(depth: float) -> float:
        return model["stiffness"] * depth**power / power - 0.5 * mass * speed**2 - pull * depth

    fast = (power * mass * speed**2 / model["stiffness"]) ** (1.0 / power)
    slow = (2.0 * power * pull / model["stiffness"]) ** (1.0 / model["exponent"])
    return brentq(excess, 0.5 * fast, fast + slow)


def make(advice: pd.DataFrame, settings: dict, *, threads: int = 1) -> dict[str, list]:
    """The table for the advised amplitudes; without advice it has no rows."""
    variants = contacts(settings)
    rows = []
    models = [
        settings["model"] | {key: contact[key] for key in ("stiffness", "damping")} for contact in variants.values()
    ]
    for row in advice.itertuples():
        amplitude = np.array([row.acceleration])
        populations = [population(amplitude, {**settings, "model": model}) for model in models]
        run = follow_parts(np.concatenate(populations), settings, threads=threads)
        speed = 0.0 if math.isnan(row.impact_speed) else row.impact_speed
        for (variant, contact), model, measures in zip(
            variants.items(), models, summarize_populations(run, settings["starts"]).to_dict("records"), strict=True
        ):
            impact = restitution(on_level_plate(model), speed) if speed > 0.0 else math.nan
            about = {"variant": variant, "aim": row.aim, "acceleration": row.acceleration, "speed": speed}
            rows.append(about | contact | {"restitution": impact} | measures)
    return fields.columns(rows, TABLES["variants"])
