"""The companion in headless Chromium: agreement with the library, and use by mouse and keyboard."""

import json
import math
import re
import time
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from browser import chromium
from project import ROOT, read_config
from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from conveyor.analysis.attractors import labels
from conveyor.simulation import Run, simulate
from conveyor.solver import model
from conveyor.solver.model import Conveyor, Start
from conveyor_pipeline.common import grid
from conveyor_pipeline.common.rule_log import JobError
from conveyor_pipeline.config.entries import resolve
from conveyor_pipeline.pages.companion import build

CONFIG = read_config()
MAPS = ("map_height", "map_amplitude", "map_velocity")
SETTINGS = 100  # random ones, at which the accuracy is measured
PHONE, DESKTOP = (360, 740), (1280, 900)
PLOTS = ("velocity", "height", "contact", "friction", "phase", "distance")

# -- the page and the browser ------------------------------------------------------------------------------------------


def coarse_map(name: str) -> pd.DataFrame:
    """A state map of the config on a few points of its axes."""
    settings = resolve(CONFIG, "sweeps", name)
    settings["axes"] = {axis: {**values, "num": 12} for axis, values in settings["axes"].items()}
    axes, parameters = grid.product(settings["axes"], settings["model"], (0, 144))
    table = pd.DataFrame(axes | {"state": labels.classify(parameters, tolerance=settings["tolerance"]).state})
    table.attrs = settings
    return table


@pytest.fixture(scope="module")
def maps() -> list[pd.DataFrame]:
    return [coarse_map(name) for name in MAPS]


@pytest.fixture(scope="module")
def address(maps, tmp_path_factory) -> str:
    path = tmp_path_factory.mktemp("companion") / "companion.html"
    path.write_text(build.make(maps, CONFIG), encoding="utf-8")
    return path.as_uri()


class Browser:
    """Chromium on the page."""

    def __init__(self, driver: webdriver.Chrome, address: str):
        self.driver = driver
        self.address = address

    def open(self, choice: str = "", size: tuple[int, int] = DESKTOP, motion: str = "reduce") -> None:
        """Load the page with a selection in its address, as in "#acceleration=80"."""
        width, height = size
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": size == PHONE}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
        media = {"features": [{"name": "prefers-reduced-motion", "value": motion}]}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", media)
        self.driver.get("about:blank")
        self.driver.get(self.address + choice)
        self.until("return document.getElementById('state').textContent !== ''")

    def run(self, script: str, *arguments):
        return self.driver.execute_script(script, *arguments)

    def until(self, script: str, *arguments) -> None:
        for _ in range(200):
            if self.run(script, *arguments):
                return
            time.sleep(0.05)
        raise AssertionError(f"never true: {script}")

    def text(self, name: str) -> str:
        return self.run("return document.getElementById(arguments[0]).textContent", name)

    def change(self, name: str, value: float) -> None:
        """Enter a value into a field, or choose an option."""
        script = "const field = document.getElementById(arguments[0]); field.value = arguments[1];"
        self.run(script + "field.dispatchEvent(new Event('change'))", name, value)

    def number(self, name: str) -> float:
        """The number that a result shows."""
        return float(self.text(name).split(" ")[0].replace("−", "-"))

    def velocity(self) -> float:
        return self.number("velocity")

    def chosen(self, name: str) -> float:
        """The value in the field of a parameter, in the unit of the page."""
        return float(self.run("return document.getElementById(arguments[0]).value", f"parameter-{name}"))

    def press(self, *keys: str) -> None:
        ActionChains(self.driver).send_keys(*keys).perform()

    def tab_to(self, script: str) -> None:
        """Press the tabulator until the element in focus satisfies `script`."""
        for _ in range(60):
            self.press(Keys.TAB)
            if self.run(f"const element = document.activeElement; return {script}"):
                return
        raise AssertionError(f"the keyboard never reaches {script}")

    def errors(self) -> list[dict]:
        return self.driver.get_log("browser")


@pytest.fixture(scope="module")
def browser(address, tmp_path_factory):
    driver = chromium(tmp_path_factory.mktemp("profile"))
    found = Browser(driver, address)
    found.open()
    yield found
    driver.quit()


# -- the numbers -------------------------------------------------------------------------------------------------------


def random_settings() -> list[tuple[Conveyor, Start]]:
    """Settings of the page: half within its main controls, half within the ranges of all of its sliders."""
    generator = np.random.default_rng(1)
    found = []
    for k in range(SETTINGS):
        values = {"acceleration": generator.uniform(0.0, 100.0), "psi0": generator.uniform(0.0, 6.28)}
        start = Start(generator.uniform(0.0, 1e-3))
        if k % 2:
            start = Start(start.z, generator.uniform(-0.5, 0.5))
            uniform = {
                **{"frequency": (5.0, 200.0), "angle": (0.0, math.pi / 2), "phase_shift": (-math.pi, math.pi)},
                **{"inclination": (-0.35, 0.35), "friction": (0.0, 1.0), "damping": (0.0, 2.0)},
                **{"exponent": (1.0, 3.0), "gravity": (0.1, 25.0)},
            }
            values |= {name: generator.uniform(*limits) for name, limits in uniform.items()}
            values |= {"stiffness": 10.0 ** generator.uniform(3.0, 9.0), "mass": 10.0 ** generator.uniform(-5.0, -1.0)}
            values["static_friction"] = values["friction"] * generator.choice([1.0, 1.5])
        tension = str(generator.choice(model.TENSION_MODES))
        found.append((Conveyor(**{name: float(value) for name, value in values.items()}, tension=tension), start))
    return found


def parameters_of(conveyor: Conveyor, start: Start) -> dict:
    return {**asdict(conveyor), "z0": start.z, "vz0": start.vz}


FOLLOW = """
const [cases, count, last, line] = arguments;
return cases.map(([parameters, duration]) => {
  const run = solver.follow(parameters, duration);
  if (run.status !== "ok") return { status: run.status };
  const resolved = solver.resolvedUntil(run, solver.follow(parameters, duration, 2), line);
  const times = Array.from({ length: count }, (_, k) => (k * duration) / (count - 1));
  const parts = times.map((time) => run.at(time));
  const columns = Object.fromEntries(Object.keys(parts[0]).map((name) => [name, parts.map((one) => one[name])]));
  const measures = [run.meanVelocity(last), run.impactSpeed(last), run.peakForce(last)];
  return { status: "ok", resolved, columns, measures, impacts: run.impacts };
});
"""
POINTS = 1001


def follow(browser, cases: list[tuple[Conveyor, Start, float]]) -> list[dict]:
    """Trajectories of the page at POINTS even times."""
    given = [[parameters_of(conveyor, start), duration] for conveyor, start, duration in cases]
    return browser.run(FOLLOW, given, POINTS, build.LAST, build.LINE)


def deviation(found: dict, run: Run, duration: float) -> float:
    """Largest deviation of the curves of z and vx until they are resolved, in units of the heights of their plots."""
    times = np.linspace(0.0, duration, POINTS)
    seen = times <= found["resolved"]
    truth = run.sample(times)
    conveyor, omega = run.conveyor, 2.0 * math.pi * run.conveyor.frequency
    plate = {
        "z": conveyor.acceleration * math.sin(conveyor.angle) / omega**2,
        "vx": conveyor.acceleration * math.cos(conveyor.angle) / omega,
    }
    return max(
        float(np.max(np.abs(np.array(found["columns"][name]) - truth[name])[seen]))
        / np.ptp([*truth[name], -plate[name], plate[name]])
        for name in ("z", "vx")
    )


def test_the_stated_accuracy_is_measured(browser):
    cases = [(*setting, 20.0 / setting[0].frequency) for setting in random_settings()]
    within, errors = 0, []
    for (conveyor, start, duration), found in zip(cases, follow(browser, cases), strict=True):
        assert found["status"] == "ok"
        run = simulate(conveyor, start, duration=duration, tolerance=1e-11)
        within += int(deviation(found, run, duration) <= build.LINE)
        if found["resolved"] == duration and run.mean_velocity() != 0.0:
            errors.append(abs(found["measures"][0] / run.mean_velocity() - 1.0))
    assert len(errors) > 0.6 * SETTINGS
    measured = {
        "settings": SETTINGS,
        "within_a_line": within,
        "median_velocity_error": float(f"{np.median(errors):.0e}"),
    }
    assert within >= 0.95 * SETTINGS
    stored = json.loads((build.HERE / "accuracy.json").read_text(encoding="utf-8"))
    assert stored == measured, "store the measured accuracy in accuracy.json"


def test_forces_agree_with_the_library(browser):
    feeder = Conveyor(acceleration=47.0, tension="clip", inclination=0.05, phase_shift=1.0, static_friction=0.3)
    cases = [(conveyor, Start("conveyor"), 0.3) for conveyor in (feeder, Conveyor(acceleration=47.0))]
    for (conveyor, start, duration), found in zip(cases, follow(browser, cases), strict=True):
        truth = simulate(conveyor, start, duration=duration).sample(np.linspace(0.0, duration, POINTS))
        for name, column in (("contact_force", "contactForce"), ("friction_force", "frictionForce")):
            errors = np.abs(np.array(found["columns"][column]) - truth[name]) / np.ptp(truth[name])
            # A force that jumps does so within one step.
            assert np.quantile(errors, 0.98) < build.LINE, name
        rests = (truth["contact_force"] > 0.0) & (
            np.abs(truth["friction_force"]) < 0.9 * conveyor.friction * truth["contact_force"]
        )
        assert np.mean((np.array(found["columns"]["motion"]) == "stick") == rests) > 0.98


def test_euler_agrees_with_the_library(browser):
    feeder = {"inclination": 0.05, "phase_shift": 1.0}
    for changes in (*({"tension": tension} for tension in model.TENSION_MODES), feeder, {"static_friction": 0.4}):
        conveyor, start = Conveyor(**changes), Start(0.3e-3)
        truth = simulate(conveyor, start, duration=0.2, method="euler", step=5e-7)
        script = "const run = solver.euler(arguments[0], 0.2, 5e-7); const {x, vx, z, vz} = run.at(0.2);"
        found = browser.run(script + "return [x, vx, z, vz, run.meanVelocity(0.25)]", parameters_of(conveyor, start))
        expected = [truth.x_end, truth.vx_end, truth.z_end, truth.vz_end, truth.mean_velocity()]
        assert found == pytest.approx(expected, rel=1e-9)


# -- what is shown -----------------------------------------------------------------------------------------------------


def test_shows_what_the_library_finds(browser):
    for name in sorted(set(CONFIG["companion"]["presets"]) - {"chaos"}):
        browser.open("#" + "&".join(f"{key}={value}" for key, value in CONFIG["companion"]["presets"][name].items()))
        values = {**CONFIG["model"], **CONFIG["companion"]["presets"][name]}
        start = Start(values.pop("z0"), values.pop("vz0"))
        run = simulate(Conveyor(**values), start, duration=CONFIG["solver"]["duration"])
        if name in build.STATES:
            assert browser.text("state").lower().startswith(f"{name} state")
        assert ("No map" in browser.text("state")) == (name == "climbing_track")
        assert browser.velocity() == pytest.approx(run.mean_velocity(), rel=1e-3)
        assert browser.number("impact-speed") == pytest.approx(run.impact_speed, rel=1e-3)
        assert browser.number("peak-force") == pytest.approx(run.peak_force, rel=1e-3)
        rows = browser.run(
            "return [...document.querySelectorAll('#impacts tr')].map((row) => row.cells[1].textContent)"
        )
        impacts = run.events["time"][run.events["kind"] == "impact"]
        assert [float(row) for row in rows] == pytest.approx(impacts.tolist(), abs=2e-5)


def test_nothing_moves_a_part_along_a_plate_at_rest(browser):
    browser.open("#acceleration=0&z0=0.0003")
    assert browser.velocity() == 0.0


def test_a_state_comes_from_a_map_or_is_not_named(browser):
    browser.open("#acceleration=80")
    assert browser.text("state").startswith("Chaos")
    assert "comes from a map" in browser.text("state")
    # The page does not show digits that depend on its step.
    for measure in ("velocity", "impact-speed", "peak-force"):
        assert "depends on the step" in browser.text(measure)
        assert len(re.match(r"0\.0*(\d+) ", browser.text(measure))[1]) <= 2
    assert "another step gives other impacts" in browser.text("impacts-note")
    # Without a map for this conveyor the page does not call the motion chaos.
    browser.open("#acceleration=80&damping=0.29")
    assert browser.text("state").startswith("The part jumps")
    assert "No map" in browser.text("state")


def test_a_run_with_too_many_steps_says_so_and_draws_nothing(browser):
    browser.open("#frequency=20000")
    alert = browser.driver.find_element(By.ID, "failure")
    assert alert.get_attribute("role") == "alert"
    assert alert.is_displayed()
    assert "draws nothing" in alert.text
    assert not browser.driver.find_element(By.ID, "shown").is_displayed()
    assert "not known" in browser.text("velocity")


def coloured_pixels(browser: Browser, name: str, colour: str) -> int:
    """Pixels of one colour on a canvas."""
    script = """
    const canvas = document.getElementById(arguments[0]);
    const {data} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const wanted = [1, 3, 5].map((k) => parseInt(arguments[1].slice(k, k + 2), 16));
    let count = 0;
    for (let k = 0; k < data.length; k += 4) count += wanted.every((value, i) => Math.abs(data[k + i] - value) < 3);
    return count;
    """
    return browser.run(script, name, colour)


def test_chaos_has_no_deviation_of_euler(browser):
    browser.open("#acceleration=80")
    browser.driver.find_element(By.ID, "euler").click()
    browser.until("return !document.getElementById('euler-velocity').textContent.includes('…')")
    assert re.fullmatch(r"0\.0*\d{1,2} m/s", browser.text("euler-velocity"))


def test_curves_have_the_colour_of_the_state(browser):
    for choice, state in (("#z0=0&vz0=0&damping=0.3&mass=0.0007", "first"), ("#z0=0.0003", "second")):
        browser.open(choice)
        for plot in PLOTS:
            assert coloured_pixels(browser, f"plot-{plot}", build.style.STATE_COLOURS[state]) > 100, plot


def test_a_second_part_converges_or_separates(browser):
    distances = {}
    for name, choice in (("regular", "#z0=0.0003"), ("chaos", "#acceleration=80")):
        browser.open(choice)
        label = browser.driver.find_element(By.ID, "plot-distance").get_attribute("aria-label")
        first, distances[name] = (float(number) for number in re.findall(r"([\d.e-]+) m at", label))
        assert first == build.SEPARATION
    assert distances["regular"] < 1e-10
    assert distances["chaos"] > 1e-4


def test_an_euler_that_blows_up_is_not_drawn(browser):
    for choice, drawn in (("#z0=0.0003", True), ("#stiffness=1e9&exponent=1&damping=2&mass=0.0005&z0=0.0003", False)):
        browser.open(choice)
        browser.driver.find_element(By.ID, "euler").click()
        browser.until("return !document.getElementById('euler-velocity').textContent.includes('…')")
        assert ("blows up" in browser.text("euler-velocity")) != drawn
        assert ("%" in browser.text("euler-velocity")) == drawn
        assert ("Euler" in browser.text("legend")) == drawn
        assert (coloured_pixels(browser, "plot-height", build.style.EULER) > 20) == drawn


@pytest.mark.parametrize("size", [PHONE, DESKTOP])
def test_no_errors_and_no_cut_text(browser, size):
    for choice in ("", "#acceleration=80", "#z0=conveyor&tension=clip"):
        browser.open(choice, size)
        browser.run("document.querySelector('details').open = true; document.getElementById('euler').click()")
        browser.until("return !document.getElementById('euler-velocity').textContent.includes('…')")
        width, wide = browser.run("return [innerWidth, document.documentElement.scrollWidth]")
        assert width == size[0]
        assert wide <= width
    assert browser.errors() == []


def test_the_animation_waits_if_reduced_motion_is_preferred(browser):
    browser.open()
    assert browser.text("play") == "Play"
    browser.open(motion="no-preference")
    assert browser.text("play") == "Pause"
    before = browser.text("readout")
    browser.until("return document.getElementById('readout').textContent !== arguments[0]", before)


def test_the_throw_number_includes_the_inclination(browser):
    browser.open("#acceleration=50&angle=0.3&inclination=0.2")
    expected = 50.0 * math.sin(0.3) / (CONFIG["model"]["gravity"] * math.cos(0.2))
    assert browser.number("throw-number") == pytest.approx(expected, rel=1e-3)


def test_the_scene_shows_the_track_and_the_drive(browser):
    for choice, track, drive in (
        ("", "level track", "straight line"),
        ("#inclination=0.1&phase_shift=1", "track inclined by 5.7", "ellipse"),
    ):
        browser.open(choice)
        label = browser.driver.find_element(By.ID, "scene").get_attribute("aria-label")
        assert track in label and drive in label
        left, right = (plate_surface(browser, share) for share in (0.1, 0.95))
        assert right - left < -20 if choice else abs(right - left) <= 1


def plate_surface(browser: Browser, share: float) -> int:
    """Row of the topmost pixel of the plate in the scene, at a share of the scene's width."""
    script = """
    const canvas = document.getElementById("scene");
    const {data} = canvas.getContext("2d").getImageData(Math.round(arguments[0] * canvas.width), 0, 1, canvas.height);
    const plate = getComputedStyle(document.documentElement).getPropertyValue("--plate").trim();
    const wanted = [1, 3, 5].map((k) => parseInt(plate.slice(k, k + 2), 16));
    const isPlate = (row) => wanted.every((value, i) => Math.abs(data[4 * row + i] - value) < 3);
    return Array.from({length: canvas.height}, (_, row) => row).findIndex(isPlate);
    """
    return browser.run(script, share)


# -- by hand -----------------------------------------------------------------------------------------------------------


def test_sliders_by_keyboard(browser):
    browser.open()
    browser.tab_to("element.type === 'range' && element.getAttribute('aria-label').startsWith('Amplitude')")
    assert browser.run("return getComputedStyle(document.activeElement).outlineStyle") == "solid"
    before = browser.velocity()
    browser.press(Keys.ARROW_RIGHT, Keys.ARROW_RIGHT)
    browser.until("return location.hash.includes('acceleration=40.2')")
    assert browser.velocity() != before
    conveyor = Conveyor(acceleration=40.2)
    truth = simulate(conveyor, Start(0.3e-3)).mean_velocity()
    assert browser.velocity() == pytest.approx(truth, rel=1e-3)


def test_the_map_by_keyboard(browser):
    browser.open()
    browser.tab_to("element.id === 'map'")
    assert browser.run("return getComputedStyle(document.activeElement).outlineStyle") == "solid"
    assert "second state" in browser.text("map-here")
    # Higher phases lead into the first state.
    for _ in range(4):
        browser.press(Keys.ARROW_UP)
    axis = resolve(CONFIG, "sweeps", "map_height")["axes"]["psi0"]
    phase = 4.0 * (axis["stop"] - axis["start"]) / 11
    browser.until("return Math.abs(document.getElementById('parameter-psi0').value - arguments[0]) < 1e-5", phase)
    assert browser.text("state").startswith("First state")
    assert "first state" in browser.text("map-here")


@pytest.mark.parametrize("size", [PHONE, DESKTOP])
def test_a_click_into_the_map_sets_the_initial_condition(browser, maps, size):
    browser.open("", size)
    canvas = browser.driver.find_element(By.ID, "map")
    browser.run("arguments[0].scrollIntoView({block: 'center'})", canvas)
    seen = set()
    for place in ((90, -70), (90, 40), (0, 90)):
        before = browser.text("map-here")
        ActionChains(browser.driver).move_to_element_with_offset(canvas, *place).click().perform()
        browser.until("return document.getElementById('map-here').textContent !== arguments[0]", before)
        z0, psi0 = 1e-3 * browser.chosen("z0"), browser.chosen("psi0")
        # A click selects a grid point. The page shows its state from the table, in the colour of the state.
        (state,) = maps[0].state[np.isclose(maps[0].z0, z0) & np.isclose(maps[0].psi0, psi0)]
        assert f"{state} state" in browser.text("map-here")
        assert states_at(browser, place) == {state}
        assert (z0 > 0.25e-3) == (place[0] > 0)
        assert (psi0 > math.pi) == (place[1] < 0)
        seen.add(state)
    assert seen == {"first", "second"}


def states_at(browser: Browser, place: tuple[int, int]) -> set[str]:
    """The states whose colours the map shows near a point, given in pixels from the middle."""
    script = """
    const canvas = document.getElementById("map");
    const [x, y] = [canvas.width / 2 + arguments[0], canvas.height / 2 + arguments[1]];
    const pixels = canvas.getContext("2d").getImageData(x - 4, y - 4, 9, 9).data;
    const hex = (k) => "#" + [0, 1, 2].map((i) => pixels[k + i].toString(16).padStart(2, "0")).join("");
    return Array.from({length: 81}, (_, k) => hex(4 * k));
    """
    colours = set(browser.run(script, *place))
    return {state for state, colour in build.style.STATE_COLOURS.items() if colour.lower() in colours}


def test_a_map_of_another_conveyor_is_marked(browser):
    browser.open("#damping=0.2")
    mark = browser.driver.find_element(By.ID, "map-other")
    assert mark.is_displayed()
    assert mark.text == "for another conveyor"
    assert "contact damping 0.3 N s/m instead of 0.2 N s/m" in browser.text("map-here")
    browser.driver.find_element(By.ID, "map-take").click()
    browser.until("return document.getElementById('map-other').hidden")
    assert browser.chosen("damping") == 0.3
    # Friction and the phase shift do not act on the motion normal to the track; the inclination does.
    for choice, other in (("#friction=0.4&static_friction=0.5&phase_shift=1", False), ("#inclination=0.1", True)):
        browser.open(choice)
        assert browser.driver.find_element(By.ID, "map-other").is_displayed() == other


def test_a_preset_shows_a_map_of_its_conveyor(browser):
    browser.open()
    assert browser.text("map-axes").startswith("Initial height")
    preset = browser.driver.find_element(By.XPATH, "//button[contains(., 'Chaos')]")
    preset.click()
    browser.until("return document.getElementById('map-axes').textContent.startsWith('Amplitude')")
    assert not browser.driver.find_element(By.ID, "map-other").is_displayed()
    assert "chaos" in browser.text("map-here")


def test_a_map_takes_an_initial_velocity_of_zero(browser):
    browser.open("#damping=0.2")
    browser.change("map-choice", 2)
    assert browser.text("map-axes").startswith("Initial velocity")
    browser.driver.find_element(By.ID, "map-take").click()
    browser.until("return document.getElementById('map-other').hidden")
    assert browser.chosen("damping") == 0.3
    assert browser.chosen("vz0") == 0.0


def test_a_wrong_value_is_named_and_changes_nothing(browser):
    browser.open()
    before = browser.velocity()
    entry = browser.driver.find_element(By.ID, "parameter-acceleration")
    entry.clear()
    entry.send_keys("-5", Keys.TAB)
    message = browser.driver.find_element(By.ID, "parameter-acceleration-wrong")
    assert message.is_displayed()
    assert "from 0 m/s² to 10000 m/s²" in message.text
    assert entry.get_attribute("aria-invalid") == "true"
    assert browser.velocity() == before


def test_a_wrong_duration_is_named_and_changes_nothing(browser):
    browser.open()
    before = browser.velocity()
    browser.change("duration", 6)
    message = browser.driver.find_element(By.ID, "duration-wrong")
    assert message.is_displayed()
    assert message.text == "The duration must be from 0.1 to 5 s. The page keeps 1 s."
    assert browser.velocity() == before
    browser.change("duration", 2)
    assert not message.is_displayed()


def test_static_friction_equals_sliding_friction_by_default(browser):
    browser.open("#friction=0.2")
    browser.run("document.querySelector('details').open = true")
    entry = browser.driver.find_element(By.ID, "parameter-static_friction")
    assert browser.chosen("static_friction") == 0.2
    assert not entry.is_enabled()
    browser.driver.find_element(By.ID, "parameter-static_friction-automatic").click()
    browser.until("return location.hash.includes('static_friction=0.2')")
    entry.clear()
    entry.send_keys("0.1", Keys.TAB)
    message = browser.driver.find_element(By.ID, "parameter-static_friction-wrong")
    assert "must not be below the friction coefficient" in message.text
    entry.clear()
    entry.send_keys("0.3", Keys.TAB)
    browser.until("return location.hash.includes('static_friction=0.3')")
    assert not message.is_displayed()
    # An address in which the coefficients contradict each other is refused.
    browser.open("#friction=0.2&static_friction=0.1")
    assert "cannot use" in browser.text("address")
    assert browser.chosen("friction") == CONFIG["model"]["friction"]


def test_every_element_in_the_tab_order_has_a_name(browser):
    browser.open()
    browser.run("document.querySelector('details').open = true")
    nodes = browser.driver.execute_cdp_cmd("Accessibility.getFullAXTree", {})["nodes"]
    focusable = [
        node
        for node in nodes
        if any(one["name"] == "focusable" and one["value"]["value"] for one in node.get("properties", ()))
    ]
    assert len(focusable) > 30
    unnamed = [node["role"]["value"] for node in focusable if not node.get("name", {}).get("value")]
    assert [role for role in unnamed if role != "RootWebArea"] == []
    images = [node for node in nodes if node.get("role", {}).get("value") in ("img", "image")]
    assert len(images) >= len(PLOTS) + 1
    assert all(node["name"]["value"] for node in images)


# -- the file ----------------------------------------------------------------------------------------------------------


def test_the_page_is_one_file_without_external_resources(browser):
    browser.open()
    path = Path(browser.address.removeprefix("file://"))
    assert browser.run("return performance.getEntriesByType('resource').length") == 0
    text = path.read_text(encoding="utf-8")
    assert not re.findall(r"https?:|//[a-z]+\.", text)
    assert "default-src 'none'" in text


def test_the_stored_page_is_made_from_the_sources():
    text = (ROOT / "docs/companion.html").read_text(encoding="utf-8")
    assert len(text.encode()) <= 5_000_000
    for name in build.PARTS:
        assert (build.HERE / name).read_text(encoding="utf-8").strip() in text, f"snakemake docs/companion.html: {name}"


def test_a_map_has_two_even_axes(maps):
    table = maps[0].copy()
    with pytest.raises(JobError, match="z0 must be evenly spaced"):
        build.encode(table.assign(z0=table.z0.replace(table.z0.max(), 1.0)))
    table.attrs = {**table.attrs, "axes": {"z0": {}}}
    with pytest.raises(JobError, match="needs two axes"):
        build.encode(table)


def test_harmonics_of_the_plate_are_refused_by_name(maps):
    """The page would draw the motion on a plate without them."""
    model = CONFIG["model"] | {"harmonics": [{"order": 2, "along": 0.5, "normal": 0.5}]}
    with pytest.raises(JobError, match="harmonics"):
        build.make(maps, CONFIG | {"model": model})
