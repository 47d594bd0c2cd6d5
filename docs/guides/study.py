"""A study of two dampings: attractors, basins, labels, bifurcations, orbits, exponents and dimensions."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import conveyor as cv

SIZE = 100  # points along an axis; a minute or two with 100
DAMPINGS = (0.2, 0.3)  # N s/m
JUMPING = cv.Start(z=3e-4)
heights, phases = np.linspace(0.0, 1e-3, SIZE), np.linspace(0.0, 2.0 * np.pi, SIZE, endpoint=False)
amplitudes = np.linspace(40.0, 80.0, 4 * SIZE)
figure, axes = plt.subplots(3, len(DAMPINGS), figsize=(9, 9), layout="constrained")
rows = []

# Bifurcation diagrams: along an axis, each amplitude begins where the one before ended.
dampings = np.array(DAMPINGS)[:, None]
table = cv.parameter_table(cv.Conveyor(), JUMPING, damping=dampings, acceleration=amplitudes)
diagram = cv.bifurcation_diagram(table, strobes=32, threads=2, progress="diagram")

for k, damping in enumerate(DAMPINGS):
    one = cv.Conveyor(acceleration=50.0, damping=damping)
    axes[0, k].plot(np.repeat(amplitudes, 32), 1e6 * diagram.delta[k].ravel(), ",k")
    axes[0, k].set(title=f"damping {damping} N s/m", xlabel="amplitude in m/s²", ylabel="δ in µm")

    # Labels of SIZE² initial conditions in height and phase, and how uncertain they are near their boundary.
    found = cv.attractors(one)
    grid = cv.parameter_table(one, z0=heights[:, None], psi0=phases)
    labels = cv.classify(grid, attractors=found, other_tolerance=1e-11, threads=2, progress="labels")
    labels.to_frame(grid).to_parquet(f"labels_{damping}.parquet")
    axes[1, k].pcolormesh(phases, 1e3 * heights, labels.attractor)
    axes[1, k].set(xlabel="phase in rad", ylabel="height in mm")
    basin = cv.basin(one, heights, np.linspace(-0.3, 0.3, SIZE), threads=2, progress="basin")
    axes[2, k].pcolormesh(basin.vz, 1e3 * basin.z, basin.attractor)
    axes[2, k].set(xlabel="velocity in m/s", ylabel="height in mm")

    # The branch of the jumping orbit, and its first period doubling over damping and amplitude.
    orbit = cv.periodic_orbit(one, JUMPING, period=range(1, 9))
    assert orbit is not None, "the part does not settle to a periodic motion"
    branch = cv.continue_orbit(orbit, "acceleration", (10.0, 60.0))
    kinds = [point.kind for point in branch.bifurcations]
    fold, doubling = (branch.bifurcations[kinds.index(kind)] for kind in ("fold", "period_doubling"))
    curve = cv.continue_bifurcation(doubling, "damping", (0.15, 0.4))
    curve.to_frame().to_parquet(f"doubling_{damping}.parquet")

    # Exponents and dimensions where the motion is chaotic.
    chaotic = cv.parameter_table(one, JUMPING, acceleration=80.0)
    exponents = cv.lyapunov_spectrum(chaotic, transient=500)
    points = cv.strobes(chaotic, 200 * SIZE)
    rows.append(
        {"damping": damping, "attractors": len(found.found), "confirmed": labels.confirmed.mean()}
        | {"uncertainty": cv.uncertainty_exponent(labels.attractor).value}
        | {"multiplier": abs(orbit.multipliers[0]), "fold": fold.orbit.acceleration}
        | {"doubling": doubling.orbit.acceleration, "lambda_1": float(exponents.lambda_1)}
        | {"dimension": cv.correlation_dimension(points).value, "boxes": cv.box_dimension(points).value}
    )
summary = pd.DataFrame(rows)
print(summary.to_string())
figure.savefig("study.png")
