"""Diagrams for the explanation of the solver, from trajectories on the paper's conveyor."""

import io

import numpy as np
from PIL import Image

from conveyor import Conveyor, Run, Start, plate_motion, simulate
from conveyor_pipeline.figures import style
from conveyor_pipeline.pages import pictures

JUMPING = Start(z=3e-4)


def shade(axes, times: np.ndarray, where: np.ndarray, label: str) -> None:
    """Draw a grey background while a condition holds."""
    axes.fill_between(times, 0, 1, where=where, transform=axes.get_xaxis_transform(), color="0.92", label=label)


def event_times(run: Run, kind: str, begin: float) -> np.ndarray:
    """Times (s) of the events of one kind after `begin`."""
    times = run.events["time"][run.events["kind"] == kind]
    return times[times >= begin]


def draw_cycle() -> style.Figure:
    """Draw flight and contact over two cycles of a settled jumping motion."""
    conveyor = Conveyor(acceleration=40.0)
    run = simulate(conveyor, JUMPING, duration=1.0)
    begin = run.duration - 2.0 / conveyor.frequency
    times = np.linspace(begin, run.duration, 2001)
    part, plate = run.sample(times), plate_motion(conveyor, times)
    figure = style.figure(style.PAGE, 66.0)
    axes = figure.subplots()
    shade(axes, times, part["contact_force"] > 0.0, "contact (Taylor series)")
    axes.plot(times, 1e3 * plate["z"], **style.PLATE_CURVE)
    axes.plot(times, 1e3 * part["z"], color=style.CONVERGED, label="part (parabola in flight)")
    for kind, marker in (("impact", "v"), ("separation", "^")):
        t = event_times(run, kind, begin)
        axes.plot(
            t, 1e3 * run.sample(t)["z"], marker, color=style.EULER, markersize=5, label=f"{kind} (root of the gap)"
        )
    axes.set_xlabel("time in s")
    axes.set_ylabel("height in mm")
    figure.legend(loc="outside upper center", ncols=3)
    return figure


def draw_contact() -> style.Figure:
    """Draw one contact in time and in the variables of the solver."""
    conveyor = Conveyor(acceleration=40.0)
    run = simulate(conveyor, JUMPING, duration=1.0)
    begin = event_times(run, "impact", 0.9)[0]
    end = event_times(run, "separation", begin)[0]
    # More samples towards both ends, where the square root is steep.
    times = begin + (end - begin) * 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, 4001)))
    penetration = np.maximum(plate_motion(conveyor, times)["z"] - run.sample(times)["z"], 0.0)
    root = np.sqrt(penetration)
    middle = 0.5 * (root[1:] + root[:-1])
    own_time = np.concatenate([[0.0], np.cumsum(np.diff(times) / middle)])
    elastic = conveyor.stiffness / conveyor.mass * penetration**conveyor.exponent
    figure = style.figure(style.PAGE, 60.0)
    left, right = figure.subplots(1, 2)
    left.plot(1e6 * (times - begin), elastic, color=style.CONVERGED)
    left.set_xlabel("time since impact $t$ in µs")
    left.set_ylabel("elastic force over mass in m/s²")
    right.plot(own_time, 1e3 * root, color=style.CONVERGED)
    right.set_xlabel("solver's variable $s$, with d$t$ = $w$ d$s$, in s/m$^{1/2}$")
    right.set_ylabel("$w = \\sqrt{\\delta}$ in 10$^{-3}$ m$^{1/2}$")
    return figure


def draw_friction() -> style.Figure:
    """Draw slip and stick of a part that is always in contact."""
    conveyor = Conveyor(acceleration=2.0)
    run = simulate(conveyor, Start("conveyor"), duration=0.2)
    times = np.linspace(run.duration - 2.0 / conveyor.frequency, run.duration, 2001)
    part, plate = run.sample(times), plate_motion(conveyor, times)
    figure = style.figure(style.PAGE, 60.0)
    axes = figure.subplots()
    shade(axes, times, np.abs(part["vx"] - plate["vx"]) < 1e-9, "stick")
    axes.plot(times, plate["vx"], **style.PLATE_CURVE)
    axes.plot(times, part["vx"], color=style.CONVERGED, label="part")
    axes.set_xlabel("time in s")
    axes.set_ylabel("velocity along the plate in m/s")
    figure.legend(loc="outside upper center", ncols=3)
    return figure


def draw_states() -> style.Figure:
    """Draw the gap at one phase of successive cycles in the first state, the second state and chaos."""
    figure = style.figure(style.PAGE, 62.0)
    panels = figure.subplots(1, 2)
    cases = {"first": (40.0, 0.0), "second": (40.0, 3e-4), "chaos": (80.0, 3e-4)}
    for state, (acceleration, height) in cases.items():
        conveyor = Conveyor(acceleration=acceleration)
        cycles = np.arange(1, 121)
        run = simulate(conveyor, Start(z=height), duration=(cycles[-1] + 0.5) / conveyor.frequency)
        times = cycles / conveyor.frequency
        gap = run.sample(times)["z"] - plate_motion(conveyor, times)["z"]
        axes = panels[int(state == "chaos")]
        axes.plot(
            cycles, 1e3 * gap, ".", color=style.STATE_COLOURS[state], label=f"{state}, $z_0$ = {1e3 * height:g} mm"
        )
        axes.set_title(f"$\\hat{{a}}$ = {acceleration:g} m/s²")
    for axes in panels:
        axes.set_xlabel("excitation cycle")
        axes.set_ylabel("gap at phase $\\psi_0$ in mm")
    figure.legend(loc="outside upper center", ncols=3)
    return figure


def to_picture(figure: style.Figure) -> Image.Image:
    """A figure as an image with the resolution of all PNG files."""
    buffer = io.BytesIO()
    style.lay_out(figure)
    figure.savefig(buffer, format="png", dpi=style.RESOLUTION)
    return pictures.make(buffer)


def make() -> dict[str, Image.Image]:
    """The diagrams by name."""
    draw = {"cycle": draw_cycle, "contact": draw_contact, "friction": draw_friction, "states": draw_states}
    with style.applied():
        return {name: to_picture(function()) for name, function in draw.items()}
