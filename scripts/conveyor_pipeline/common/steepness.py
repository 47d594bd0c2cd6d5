"""Whether friction holds a part on an inclined track."""

import numpy as np


def fill_in(model: dict) -> dict:
    """A model with an inclination and a static friction."""
    return {"inclination": 0.0, "static_friction": model["friction"]} | model


def is_steep(model: dict) -> bool:
    """Whether a track is too steep for friction to stop a part that slides."""
    return bool(steepness(fill_in(model)) > 0)


def is_frictionless(model: dict) -> bool:
    """Whether nothing moves a part along a level track."""
    return fill_in(model)["static_friction"] == 0.0


def steepness(conveyors: np.ndarray | dict) -> np.ndarray:
    """How steep tracks are, int64, shape (n,): 0 where friction stops a part that slides, 2 where it does not even hold
    a part at rest, 1 between, where only parts that stick again and again have a mean velocity.

    On average, the contact force is m g cos α. Sliding friction takes at most μ times as much.

    conveyors : table of parameters, shape (n,), or a model
    """
    slope = np.abs(np.tan(conveyors["inclination"]))
    return (slope > conveyors["friction"]).astype(np.int64) + (slope > conveyors["static_friction"])
