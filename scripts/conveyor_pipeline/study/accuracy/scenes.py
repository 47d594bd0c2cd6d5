"""The motions on which methods are compared, by what sets them apart from the model of the config."""

SCENES = {
    "jumping": {"acceleration": 40.0, "z0": 0.3e-3},
    "riding": {"acceleration": 30.0, "z0": 0.0},
    "bouncing": {"acceleration": 47.0, "z0": 0.0},
    "chaotic": {"acceleration": 80.0, "z0": 0.0},
}
TRUTH = 1e-14  # tolerance of the reference solution
LONGEST = {"chaotic": 0.2}  # s; later in chaos, no two methods agree
