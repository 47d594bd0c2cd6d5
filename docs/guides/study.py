"""A study of two dampings: attractors, diagram, basins, labels, exponents, orbits, curves and dimensions."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import conveyor as cv

SIZE = 100  # points along an axis; with 100, some minutes
DAMPINGS = (0.2, 0.3)  # N s/m
JUMPING = cv.Start(z=3e-4)
figure, axes = plt.subplots(2, len(DAMPINGS), figsize=(9, 7), layout="constrained")
heights, phases = np.linspace(0.0, 1e-3, SIZE), np.linspace(0.0, 2.0 * np.pi, SIZE, endpoint=False)
rows = []
for damping, (above, below) in zip(DAMPINGS, axes.T, strict=True):
    one = cv.Conveyor(acceleration=50.0, damping=damping)
    found = cv.attractors(one, samples=SIZE)
    print(f"damping {damping}:\n{found}")

    # Bifurcation diagram: each amplitude begins where the one before ended.
    amplitudes = np.linspace(40.0, 80.0, 4 * SIZE)
    states, status = cv.bifurcation_diagram(cv.parameter_table(one, JUMPING, acceleration=amplitudes), strobes=32)
    above.plot(np.repeat(amplitudes, 32), 1e6 * states[:, :, 0].ravel(), ",k")

    # Labels of SIZE² initial conditions in (height, phase), and how uncertain their boundary is.
    grid = cv.parameter_table(one, z0=heights[:, None], psi0=phases)
    labels = cv.classify(grid, attractors=found, other_tolerance=1e-11, threads=2)
    labels.to_frame(grid).to_parquet(f"labels_{damping}.parquet")
    below.pcolormesh(phases, 1e3 * heights, labels.attractor)
    certain = cv.uncertainty_exponent(labels.attractor)

    # The basin in the state at one phase.
    basin = cv.basin(one, heights[::4], np.linspace(-0.3, 0.3, SIZE // 4))

    # The branch of the jumping orbit, its first period doubling, and the doubling over damping and amplitude.
    orbit = cv.periodic_orbit(one, JUMPING, period=range(1, 9))
    branch = cv.continue_orbit(orbit, "acceleration", (30.0, 60.0))
    folds = [one.orbit.acceleration for one in branch.bifurcations if one.kind == "fold"]
    doublings = [one for one in branch.bifurcations if one.kind == "period_doubling"]
    curves = [cv.continue_bifurcation(doubling, "damping", (0.15, 0.4)) for doubling in doublings[:1]]
    for curve in curves:
        curve.to_frame().to_parquet(f"doubling_{damping}.parquet")

    # Exponents and dimensions along the diagram's last amplitudes.
    table = cv.parameter_table(one, JUMPING, acceleration=[70.0, 80.0])
    exponents = cv.lyapunov_spectrum(table, transient=500)
    points = cv.strobes(cv.replace_parameters(table[1], acceleration=80.0), 20 * SIZE)
    dimension = cv.correlation_dimension(points)
    rows.append(
        {"damping": damping, "attractors": len(found.found), "uncertainty": certain.value}
        | {"confirmed": labels.confirmed.mean(), "second": (basin.state == "second").mean()}
        | {"fold": min(folds, default=None), "multiplier": abs(orbit.multipliers[0])}
        | {"lambda_1": exponents.lambda_1[1], "stderr": exponents.stderr[1], "dimension": dimension.value}
    )
summary = pd.DataFrame(rows)
print(summary.to_string())
figure.savefig("study.png")
