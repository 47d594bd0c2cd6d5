"""Scales of the motion normal to the track, in which the motion does not depend on the conveyor. No slow imports."""

import math
from collections.abc import Mapping

from conveyor.parameters import normal_gravity


def length_scale(model: Mapping[str, float]) -> float:
    """The unit of length, g cos α/ω² (m), of a model."""
    return normal_gravity(model) / (2.0 * math.pi * model["frequency"]) ** 2
