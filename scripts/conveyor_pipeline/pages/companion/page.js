/* The page: computes the trajectories, shows the results, and connects the elements of the page with them. */

const SLOWNESS = [20, 50, 100, 200, 500, 1000];
const SEPARATIONS = [1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4];
const CYCLES_IN_VIEW = [2, 4, 10, 25, Infinity];
// Excitation cycles by which a step button moves, and impacts that the table shows.
const STEP = 0.02;
const ROWS = 1000;
// A flight that is longer than this, in excitation cycles, is a jump, as in the state maps.
const LONG_FLIGHT = 0.5;
// Digits of the results, which the accuracy of the page justifies.
const DIGITS = 4;
// A smaller velocity (m/s) or force (N) is a rounding error.
const ROUNDING = 1e-12;

// ----------------------------------------------------------------------------------------------------------- computing

const timers = {};

/* Run an action after a delay (ms), unless the same name is used again before. */
function later(name, delay, action) {
  clearTimeout(timers[name]);
  timers[name] = setTimeout(action, delay);
}

let requested = false;

/* Compute and draw once before the next frame, however many changes come until then. */
function request() {
  if (requested) return;
  requested = true;
  requestAnimationFrame(() => {
    requested = false;
    compute();
  });
}

function compute() {
  run = solver.follow(chosen, duration);
  eulerRun = undefined;
  twin = undefined;
  if (run.status === "ok") {
    resolved = solver.resolvedUntil(run, solver.follow(chosen, duration, 2), data.line);
    if (byId("second").checked) {
      const height = chosen.z0 === "conveyor" ? plateHeight() : chosen.z0;
      twin = solver.follow({ ...chosen, z0: height + Number(byId("separation").value) }, duration);
    }
    if (byId("euler").checked) later("euler", 150, computeEuler);
  }
  stated = statedState();
  showChoice();
  showMap();
  let failure = "";
  if (run.status !== "ok") {
    failure = `The page draws nothing: ${run.status}. The library of the project computes this trajectory.`;
  } else if (twin && twin.status !== "ok") {
    failure = `The page does not draw the second part: ${twin.status}.`;
    twin = undefined;
  }
  byId("failure").textContent = failure;
  byId("failure").hidden = !failure;
  byId("shown").hidden = run.status !== "ok";
  showResults();
  if (run.status !== "ok") return;
  measureExtent();
  byId("time").max = duration;
  byId("time").step = STEP * run.c.period;
  describeScene();
  showImpacts();
  drawAll();
}

/* Whether the whole run is resolved. In chaos, any error grows until the step decides where the part is. */
const isSharp = () => resolved === duration;

/* Explicit Euler takes millions of steps, so it waits until the sliders rest. */
function computeEuler() {
  if (!byId("euler").checked || run.status !== "ok") return;
  eulerRun = solver.euler(chosen, duration, data.solver.step);
  showResults();
  drawAll();
}

/* The state to show: that of a map for these parameters, where the part moves accordingly; otherwise what the part
   does in the last quarter of the run. */
function statedState() {
  if (run.status !== "ok") return { name: undefined, text: "Not known", note: "" };
  const longest = Math.max(0, ...run.lastImpacts(data.last).map(({ flight }) => flight)) / run.c.period;
  const jumps = longest >= LONG_FLIGHT;
  const seen = `In the last quarter, the longest flight lasts ${digits(longest, 2)} cycles.`;
  const onMap = maps.filter((one) => !differences(one).length).map(stateOnMap).find(Boolean);
  if (onMap && (onMap === "chaos" || (onMap === "second") === jumps)) {
    return { name: onMap, text: STATE_NAMES[onMap], note: `This state comes from a map. ${seen}` };
  }
  const why = onMap
    ? `The nearest point of the map has another state (${STATE_NAMES[onMap].toLowerCase()}).`
    : "No map of this page contains this choice.";
  return { name: undefined, text: jumps ? "The part jumps" : "The part moves with the plate", note: `${seen} ${why}` };
}

// ------------------------------------------------------------------------------------------------------------- results

function showResults() {
  const ok = run.status === "ok";
  const note = element("small", { textContent: stated.note });
  byId("state").replaceChildren(swatch(colours[stated.name]), stated.text, note);
  const doubt = !ok || isSharp() ? "" : "unresolved: depends on the step";
  const show = (id, number, unit, count) => {
    const text = ok ? `${significant(number(), count)} ${unit}` : "not known";
    byId(id).replaceChildren(text, element("small", { textContent: doubt }));
    return text;
  };
  const mean = show("velocity", () => run.meanVelocity(data.last), "m/s", DIGITS);
  show("impact-speed", () => run.impactSpeed(data.last), "m/s", DIGITS);
  show("peak-force", () => run.peakForce(data.last), "N", DIGITS);
  byId("throw-number").textContent = signed(digits(run.c.aZ / run.c.gravity, 4));
  byId("twin-result").hidden = !twin;
  if (twin) show("twin-velocity", () => twin.meanVelocity(data.last), "m/s", DIGITS);
  byId("count").textContent = ok ? `${run.impacts.length} in ${duration} s` : "not known";
  byId("euler-result").hidden = !byId("euler").checked;
  byId("euler-velocity").textContent = eulerText();
  byId("summary").textContent = `${stated.text}, ${mean}`;
  // A screen reader announces the result when the sliders rest.
  later("announcement", 600, () => {
    const place = document.activeElement === mapCanvas ? `${byId("map-here").textContent}. ` : "";
    byId("announcement").textContent = `${place}${stated.text}. Mean feeding velocity ${mean}.`;
  });
}

/* Whether Euler's trajectory can be drawn: it may blow up. */
const eulerDrawn = () => eulerRun && eulerRun.status === "ok";

/* A result with a number of digits, or with two where it belongs to one trajectory of many. */
const significant = (value, count) =>
  signed(digits(Math.abs(value) < ROUNDING ? 0 : value, isSharp() ? count : 2));

function eulerText() {
  if (!eulerRun) return "computing …";
  if (!eulerDrawn()) return eulerRun.status;
  const [found, exact] = [eulerRun, run].map((one) => one.meanVelocity(data.last));
  const comparable = isSharp() && Math.abs(exact) > 1e-9;
  const deviation = comparable ? ` (${signed(digits((100 * (found - exact)) / exact, 2))} %)` : "";
  return `${significant(found, DIGITS)} m/s${deviation}`;
}

function showImpacts() {
  const { impacts } = run;
  const rows = impacts.slice(0, ROWS).map(({ time, speed, flight }, k) => {
    const phase = (run.c.omega * time + run.c.psi0) % (2 * Math.PI);
    const [approach, before] = [speed, 1e3 * flight].map((one) => one.toPrecision(DIGITS));
    const texts = [String(k + 1), time.toFixed(6), phase.toFixed(3), approach, before];
    const cells = texts.map((textContent) => element("td", { textContent: signed(textContent) }));
    return element("tr", { className: time <= resolved ? "" : "blurred" }, ...cells);
  });
  byId("impacts").replaceChildren(...rows);
  const notes = [];
  if (impacts.length > ROWS) notes.push(`The table lists the first ${ROWS} of ${impacts.length} impacts.`);
  if (!isSharp()) notes.push(`From ${digits(resolved, 3)} s on, the motion is unresolved: another step gives other impacts.`);
  byId("impacts-note").textContent = notes.join(" ");
}

function showReadout() {
  const part = run.at(time);
  const ground = solver.plate(run.c, time);
  const does = {
    flight: "in the air",
    stick: "sticks to the plate",
    lags: "slips, slower than the plate",
    leads: "slips, faster than the plate",
  };
  const gap = 1e6 * (part.z - ground.z);
  byId("readout").textContent = signed(
    `t = ${(1e3 * time).toFixed(2)} ms, cycle ${(time / run.c.period).toFixed(2)}: ${does[part.motion]}. ` +
      `ẋ = ${part.vx.toFixed(4)} m/s, ${gap >= 0 ? "gap" : "penetration"} ${Math.abs(gap).toFixed(2)} µm, ` +
      `contact force ${part.contactForce.toFixed(4)} N.`,
  );
}

// ----------------------------------------------------------------------------------------------------------- animation

const calm = matchMedia("(prefers-reduced-motion: reduce)");
let playing = false;
let lastFrame;

function play(on) {
  playing = on;
  byId("play").textContent = on ? "Pause" : "Play";
  lastFrame = undefined;
  if (on) requestAnimationFrame(animate);
}

function animate(now) {
  if (!playing) return;
  if (run && run.status === "ok" && extent) {
    if (lastFrame !== undefined) time += Math.min(now - lastFrame, 100) / 1e3 / Number(byId("slow").value);
    if (time > duration) time = 0;
    drawMoment();
  }
  lastFrame = now;
  requestAnimationFrame(animate);
}

function goTo(moment) {
  play(false);
  time = Math.min(Math.max(moment, 0), duration);
  drawMoment();
}

/* Draw again at another width or in another colour scheme. */
function redraw() {
  if (!run) return;
  showMap();
  if (run.status === "ok") drawAll();
}

function drawAll() {
  showLegend(looks());
  drawSignals();
  drawPhase();
  drawDistance();
  drawMoment();
}

/* Draw what changes with time: the part, the cursors of the plots, the readout. */
function drawMoment() {
  if (String(timeWindow()) !== drawnWindow) drawSignals();
  placeCursors();
  const slider = byId("time");
  slider.value = time;
  slider.setAttribute("aria-valuetext", `${(1e3 * time).toFixed(1)} ms`);
  drawScene();
  showReadout();
}

// -------------------------------------------------------------------------------------------------------------- set-up

function fill(select, values, text, value) {
  select.replaceChildren(...values.map((one) => element("option", { value: one, textContent: text(one) })));
  select.value = value;
}

function changeDuration({ target }) {
  const { value, min, max } = target;
  const right = Number(value) >= Number(min) && Number(value) <= Number(max);
  target.setAttribute("aria-invalid", String(!right));
  byId("duration-wrong").hidden = right;
  byId("duration-wrong").textContent = `The duration must be from ${min} to ${max} s. The page keeps ${duration} s.`;
  if (!right) return;
  duration = Number(value);
  time = Math.min(time, duration);
  request();
}

function connect() {
  const on = (id, event, action) => byId(id).addEventListener(event, action);
  on("tension", "change", ({ target }) => choose({ tension: target.value }));
  on("map-choice", "change", ({ target }) => {
    showOnMap(maps[Number(target.value)]);
    showMap();
  });
  on("map-take", "click", () => moveTo(...[map.x, map.y].map(valueOn)));
  on("map", "click", clickMap);
  on("map", "pointermove", (event) => {
    if (event.pointerType === "mouse" && event.buttons === 1) clickMap(event);
  });
  on("map", "keydown", steerMap);
  on("play", "click", () => play(!playing));
  on("restart", "click", () => goTo(0));
  on("back", "click", () => goTo(time - STEP * run.c.period));
  on("forth", "click", () => goTo(time + STEP * run.c.period));
  on("next", "click", () => goTo(run.impacts.find((impact) => impact.time > time + 1e-12)?.time ?? duration));
  on("time", "input", ({ target }) => goTo(target.valueAsNumber));
  on("cycles", "change", drawAll);
  for (const id of ["second", "separation", "euler"]) on(id, "change", request);
  on("duration", "change", changeDuration);
  let width;
  new ResizeObserver(([{ contentRect }]) => {
    if (contentRect.width !== width) redraw();
    width = contentRect.width;
  }).observe(document.body);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  calm.addEventListener("change", () => play(!calm.matches));
  addEventListener("hashchange", takeAddress);
}

Object.entries(CONTROLS).forEach(addControl);
Object.entries(data.presets).forEach(addPreset);
maps.forEach(unpackMap);
fill(byId("map-choice"), [...maps.keys()], (k) => mapTitle(maps[k]), 0);
fill(byId("slow"), SLOWNESS, (one) => `${one} ×`, 100);
fill(byId("separation"), SEPARATIONS, (one) => `${power10(Math.round(Math.log10(one)))} m`, data.separation);
fill(byId("cycles"), CYCLES_IN_VIEW, (one) => (one === Infinity ? "all" : one), 4);
byId("duration").value = duration;
byId("cycle-steps").textContent = Math.round(1 / solver.CYCLE_STEP);
byId("euler-step").textContent = `${plain(1e6 * data.solver.step)} µs`;
connect();
takeAddress();
showMapLegend();
play(!calm.matches);
