"""Settings in the scales of the conveyor, keys `dimensionless`, converted to SI units.

Stages of the floor machine state amplitudes as throw numbers, heights in g cos α/ω², velocities in g cos α/ω,
times in excitation cycles and frequencies over the model's, so that their defaults fit any conveyor. A value in SI
units beside `dimensionless` replaces the converted one.
"""

import math
from collections.abc import Iterator
from typing import Any

from conveyor.parameters import length_scale, normal_gravity, speed_scale
from conveyor_pipeline.config.files import merge
from conveyor_pipeline.config.schema import child, schema_at, unit_of
from conveyor_pipeline.config.stages import declared

# Where the config may have a key `dimensionless`.
SCALED = [(section, *keys) for section, places in declared("SCALED").items() for keys in places]
DIGITS = 4  # of converted values, which stand on axes and in texts


def scales_of(model: dict) -> dict[str, float]:
    """The scale of each unit: amplitude at which a_z = g cos α, g cos α/ω², g cos α/ω, period, and frequency.

    a_z is the amplitude of the fundamental, without the harmonics of the plate.
    """
    return {
        "m/s²": normal_gravity(model) / math.sin(model["angle"]),
        "m": length_scale(model),
        "m/s": speed_scale(model),
        "s": 1.0 / model["frequency"],
        "Hz": model["frequency"],
    }


def convert(value: Any, schema: dict, scales: dict[str, float]) -> Any:
    """A dimensionless value in SI units, rounded to DIGITS; `schema` is the schema of the value in SI units."""
    if isinstance(value, dict):
        return {key: convert(item, child(schema, key), scales) for key, item in value.items()}
    if isinstance(value, list):
        return [convert(item, child(schema, place), scales) for place, item in enumerate(value)]
    scale = scales.get(unit_of(schema))
    return value if scale is None else float(f"{value * scale:.{DIGITS}g}")


def section_at(config: dict, path: tuple[str, ...]) -> dict:
    for key in path:
        config = config[key]
    return config


def to_si(config: dict) -> dict:
    """A config of the right types without keys `dimensionless`."""
    scales = scales_of(config["model"])
    converted = merge(config)
    for path in SCALED:
        section, schema = section_at(converted, path), schema_at(path)
        values = section.pop("dimensionless", {})
        si_values = {key: convert(value, child(schema, key), scales) for key, value in values.items()}
        section |= merge(si_values, {key: section[key] for key in si_values if key in section})
    return converted


def ends_of(axis: Any) -> Any:
    """What remains of a value if only the number of its values is another one."""
    return {key: value for key, value in axis.items() if key != "num"} if isinstance(axis, dict) else axis


def faults_of_scales(config: dict, defaults: dict) -> Iterator[str]:
    """Values that cannot be converted, or that are given twice; one line each."""
    if math.sin(config["model"]["angle"]) <= 0.0:
        yield f"model.angle = {config['model']['angle']!r} means that no amplitude can lift a part; give a larger angle"
        return
    for path in SCALED:
        section, default = section_at(config, path), section_at(defaults, path).get("dimensionless", {})
        for key, value in section.get("dimensionless", {}).items():
            is_replaced = key in section and (ends_of(section[key]) or isinstance(value, list))
            if is_replaced and ends_of(value) != ends_of(default.get(key, value)):
                name = ".".join(path)
                yield f"{name}.{key} is given in SI units and as {name}.dimensionless.{key}; give one of them"
