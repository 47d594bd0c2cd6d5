"""An example for the open benchmark: SciPy's RK45 without events, so that impacts and slip are signs in the force."""

import numpy as np
from scipy.integrate import solve_ivp

TOLERANCES = (1e-3, 1e-4, 1e-5)


def solve(scene: dict, tolerance: float) -> dict:
    """x and z (m) at the times of a scene."""
    p = {name: entry["value"] for name, entry in scene["parameters"].items()}
    omega = 2.0 * np.pi * p["frequency"]
    a_x, a_z = p["acceleration"] * np.cos(p["angle"]), p["acceleration"] * np.sin(p["angle"])

    def rates(t, state):
        _, vx, z, vz = state
        theta = omega * t + p["psi0"]
        depth = -a_z / omega**2 * np.cos(theta) - z
        push = 0.0
        if depth >= 0.0:
            approach = a_z / omega * np.sin(theta) - vz
            push = (p["stiffness"] * depth ** p["exponent"] + p["damping"] * approach) / p["mass"]
        slip = a_x / omega * np.sin(theta) - vx
        return vx, p["friction"] * push * np.sign(slip), vz, push - p["gravity"]

    initial = [scene["initial"][name] for name in ("x", "vx", "z", "vz")]
    absolute = [tolerance * scene["scales"][name] for name in ("x", "vx", "z", "vz")]
    run = solve_ivp(rates, (0.0, scene["duration"]), initial, t_eval=scene["times"], rtol=tolerance, atol=absolute)
    return {"x": run.y[0], "z": run.y[2]}
