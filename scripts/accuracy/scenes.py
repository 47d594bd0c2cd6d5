"""The motions on which methods are compared, by what sets them apart from the model of the config."""

SCENES = {
    "jumping": {"acceleration": 40.0, "z0": 0.3e-3},
    "riding": {"acceleration": 30.0, "z0": 0.0},
    "bouncing": {"acceleration": 47.0, "z0": 0.0},
}
