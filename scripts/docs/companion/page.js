/* The page around the solver: what is chosen, what follows from it, and how it is shown. All numbers of the model come
   with the page (see build.py); quantities are in SI units except where they are shown. */

const data = JSON.parse(document.getElementById("data").textContent);
const { model, ranges, colours, maps } = data;
const byId = (id) => document.getElementById(id);

// ------------------------------------------------------------------------------------------------------ controls

// How a parameter is shown: its unit and what an SI value is multiplied by, and the reach and step of its slider in
// that unit. `log` sliders move by decades.
const CONTROLS = {
  acceleration: { label: "Amplitude â", unit: "m/s²", factor: 1, low: 0, high: 100, step: 0.1, main: true },
  z0: { label: "Start height z₀", unit: "mm", factor: 1e3, low: -0.1, high: 1, step: 0.001, main: true },
  psi0: { label: "Phase ψ₀", unit: "rad", factor: 1, low: 0, high: 6.28, step: 0.01, main: true },
  vz0: { label: "Start velocity ż₀", unit: "m/s", factor: 1, low: -0.5, high: 0.5, step: 0.001 },
  friction: { label: "Friction coefficient μ", unit: "", factor: 1, low: 0, high: 1, step: 0.01 },
  damping: { label: "Contact damping", unit: "N s/m", factor: 1, low: 0, high: 2, step: 0.01 },
  stiffness: { label: "Contact stiffness", unit: "N/mᵖ", factor: 1, low: 3, high: 9, step: 0.05, log: true },
  exponent: { label: "Contact exponent p", unit: "", factor: 1, low: 1, high: 3, step: 0.05 },
  mass: { label: "Mass m", unit: "g", factor: 1e3, low: -2, high: 2, step: 0.02, log: true },
  frequency: { label: "Frequency f", unit: "Hz", factor: 1, low: 5, high: 200, step: 0.5 },
  angle: { label: "Angle of throw φ", unit: "°", factor: 180 / Math.PI, low: 0, high: 90, step: 0.5 },
  gravity: { label: "Gravity g", unit: "m/s²", factor: 1, low: 0.1, high: 25, step: 0.01 },
};
/* A label within a sentence. */
const inText = (name) => (CONTROLS[name]?.label ?? name).replace(/^./, (letter) => letter.toLowerCase());
const STATE_NAMES = { first: "First state", second: "Second state", chaos: "Chaos", undecided: "Undecided" };
const SLOWNESS = [20, 50, 100, 200, 500, 1000];
const SEPARATIONS = [1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4];
const CYCLES_IN_VIEW = [2, 4, 10, 25, Infinity];
// What a step button moves by, in excitation cycles, and how many impacts a table shows.
const STEP = 0.02;
const ROWS = 1000;
// So few points of a map are hard to see: their number is given.
const FEW = 100;
// A start is not known better than this (m), and a time that moves by more than this (s) with it is not known.
const BLUR = 1e-13;
const SHARP = 1e-6;

let chosen = { ...model };
let duration = data.solver.duration;
let run; // of the part, with what was found about it
let twin; // the second part
let eulerRun;
let settled;
let known; // impacts whose times the start decides, see `countKnown`
let stated; // state that is shown, and its colour's name
let extent; // of the run in its plots
let time = 0;
let playing = false;
let drawnWindow = "";

/* A number without the digits that only binary fractions have. */
const plain = (number) => Number(number.toPrecision(12));
const digits = (number, count) => (number === 0 ? "0" : String(Number(number.toPrecision(count))));
/* Units are converted there and back: so the same number need not have the same last digit. */
const same = (a, b) => a === b || Math.abs(a - b) <= 1e-12 * Math.abs(b);
const signed = (text) => text.replace("-", "−");

function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

function shownAs(name, value) {
  if (value === "conveyor") return "on the plate";
  if (typeof value === "string") return value;
  const { factor, unit } = CONTROLS[name];
  return signed(`${digits(value * factor, 6)} ${unit}`.trim());
}

/* What is wrong with a value of a parameter, or nothing. */
function fault(name, value) {
  const [low, high] = ranges[name];
  if (Number.isFinite(value) && low <= value && value <= high) return "";
  return `${CONTROLS[name].label} must be a number from ${shownAs(name, low)} to ${shownAs(name, high)}.`;
}

function addControl([name, control]) {
  const { label, unit, factor, low, high, step, log, main } = control;
  const id = `parameter-${name}`;
  const number = element("input", { type: "number", id, step: "any" });
  const slider = element("input", { type: "range", min: low, max: high, step });
  const message = element("p", { className: "wrong", id: `${id}-wrong`, hidden: true });
  slider.setAttribute("aria-label", label);
  number.setAttribute("aria-describedby", message.id);

  function take(value) {
    const wrong = fault(name, value);
    message.textContent = wrong && `${wrong} What is shown keeps ${shownAs(name, chosen[name])}.`;
    message.hidden = !wrong;
    number.setAttribute("aria-invalid", String(Boolean(wrong)));
    if (!wrong) choose({ [name]: value });
  }
  number.addEventListener("change", () => take(number.value === "" ? NaN : number.valueAsNumber / factor));
  slider.addEventListener("input", () => {
    const value = log ? digits(10 ** slider.valueAsNumber, 3) : slider.valueAsNumber;
    take(plain(Number(value) / factor));
  });
  control.show = () => {
    const onPlate = chosen[name] === "conveyor";
    const value = plain((onPlate ? plateAtStart() : chosen[name]) * factor);
    number.value = digits(value, onPlate ? 4 : 7);
    number.disabled = slider.disabled = onPlate;
    number.setAttribute("aria-invalid", "false");
    message.hidden = true;
    slider.value = log ? Math.log10(value) : value;
    slider.setAttribute("aria-valuetext", `${signed(number.value)} ${unit}`.trim());
  };
  const title = element("label", { htmlFor: id, textContent: label });
  const entry = element("span", { className: "entry" }, number, element("span", { className: "unit" }, unit));
  const box = element("div", { className: "control" }, title, slider, entry, message);
  byId(main ? "main-controls" : "more-controls").append(box);
}

/* Height of the plate at the start: where a part begins that starts on it. */
function plateAtStart() {
  return solver.plate(solver.constants(chosen, data.tolerance), 0).z;
}

function choose(changes) {
  chosen = { ...chosen, ...changes };
  time = 0;
  request();
}

function showChoice() {
  for (const control of Object.values(CONTROLS)) control.show();
  byId("on-plate").checked = chosen.z0 === "conveyor";
  byId("tension").value = chosen.tension;
  const changed = Object.keys(model).filter((name) => !same(chosen[name], model[name]) || name === "acceleration");
  const hash = changed.map((name) => `${name}=${chosen[name]}`).join("&");
  // Browsers allow few of these in a short time.
  later("hash", 500, () => history.replaceState(null, "", `#${hash}`));
}

/* Choose what a preset or the address says, and show a map of that conveyor if there is one. */
function chooseAll(values) {
  choose(values);
  if (differences(map).length) showOnMap(maps.find((one) => stateOnMap(one) && !differences(one).length) || map);
}

function canBeChosen(name, value) {
  if (name === "tension") return solver.TENSIONS.includes(value);
  return (name === "z0" && value === "conveyor") || (name in CONTROLS && !fault(name, value));
}

/* Take over the choice that the address carries, as in #acceleration=80&z0=0, in SI units. */
function takeAddress() {
  const wanted = [...new URLSearchParams(location.hash.slice(1))].map(([name, text]) => [
    name,
    text === "" || Number.isNaN(Number(text)) ? text : Number(text),
  ]);
  const wrong = wanted.find((pair) => !canBeChosen(...pair));
  byId("address").textContent = wrong
    ? `The address asks for ${wrong.join(" = ")}, which cannot be used: the defaults are shown.`
    : "";
  byId("address").hidden = !wrong;
  chooseAll({ ...model, ...(wrong ? {} : wanted.length ? Object.fromEntries(wanted) : data.presets[data.opening]) });
}

// ----------------------------------------------------------------------------------------------------- computing

const timers = {};

function later(name, delay, action) {
  clearTimeout(timers[name]);
  timers[name] = setTimeout(action, delay);
}

let requested = false;

/* Compute and draw once before the next picture, however often something changes until then. */
function request() {
  if (requested) return;
  requested = true;
  requestAnimationFrame(() => {
    requested = false;
    compute();
  });
}

function compute() {
  const options = { tolerance: data.tolerance };
  const height = chosen.z0 === "conveyor" ? plateAtStart() : chosen.z0;
  const higher = (by) => solver.follow({ ...chosen, z0: height + by }, duration, options);
  run = solver.follow(chosen, duration, options);
  eulerRun = undefined;
  twin = undefined;
  if (run.status === "ok") {
    settled = solver.settle(chosen, data.cycles, options);
    known = countKnown(run.impacts(), higher(BLUR).impacts());
    if (byId("second").checked) twin = higher(Number(byId("separation").value));
    if (byId("euler").checked) later("euler", 150, computeEuler);
  }
  stated = statedState();
  showChoice();
  showMap();
  let failure = "";
  if (run.status !== "ok") {
    failure = `The solver gave up after ${digits(run.end, 4)} s of ${duration} s: ${run.status}. `;
    failure += "Nothing is drawn, because nothing behind that time is known.";
  } else if (twin && twin.status !== "ok") {
    failure = `The second part is not drawn: the solver gave up after ${digits(twin.end, 4)} s, ${twin.status}.`;
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
  showImpacts();
  drawAll();
}

/* Number of impacts whose times the start decides: in chaos rounding decides the later ones. */
function countKnown(impacts, blurred) {
  const apart = impacts.findIndex(({ time }, k) => !blurred[k] || Math.abs(time - blurred[k].time) > SHARP);
  return apart < 0 ? impacts.length : apart;
}

/* Explicit Euler takes millions of steps: it waits until the sliders rest. */
function computeEuler() {
  if (!byId("euler").checked || run.status !== "ok") return;
  const { step } = data.solver;
  eulerRun = solver.euler(chosen, duration, step, Math.max(1, Math.round(run.c.period / step / 2000)));
  showResults();
  drawAll();
}

/* The state to be shown: what the part settles in; else what a map says, whose exponents tell chaos from patience. */
function statedState() {
  if (run.status !== "ok") return { name: undefined, text: "Not known", note: "" };
  if (settled.state) {
    const does = settled.state === "first" ? "moves with the plate" : "jumps";
    const period = settled.period === 1 ? "every cycle" : `every ${settled.period} cycles`;
    const note = `It ${does} and repeats itself ${period}, from cycle ${settled.after} on.`;
    return { name: settled.state, text: STATE_NAMES[settled.state], note };
  }
  if (settled.status !== "ok") {
    const note = `The solver gave up within ${data.cycles} cycles: ${settled.status}.`;
    return { name: undefined, text: "Not known", note };
  }
  const said = maps.filter((one) => !differences(one).length).map(stateOnMap).find(Boolean);
  const text = `Not settled within ${data.cycles} cycles`;
  if (said !== "chaos") return { name: "undecided", text, note: "That alone is not chaos." };
  return { name: "chaos", text, note: "The state map says chaos here: there the Lyapunov exponent is positive." };
}

// ---------------------------------------------------------------------------------------------------- state maps

const mapCanvas = byId("map");
let map = maps[0];
let mapFrame;

function unpackMap(packed) {
  const bytes = Uint8Array.from(atob(packed.states), (letter) => letter.charCodeAt(0));
  const count = packed.x.num * packed.y.num;
  const states = Uint8Array.from({ length: count }, (_, k) => (bytes[k >> 2] >> (2 * (k & 3))) & 3);
  const picture = element("canvas", { width: packed.x.num, height: packed.y.num });
  const image = new ImageData(packed.x.num, packed.y.num);
  const pixels = new DataView(image.data.buffer);
  const palette = data.states.map((state) => parseInt(`${colours[state].slice(1)}ff`, 16));
  states.forEach((state, k) => {
    // The first row of the table is the lowest one, that of a picture the highest.
    const row = packed.y.num - 1 - Math.floor(k / packed.x.num);
    pixels.setUint32(4 * (row * packed.x.num + (k % packed.x.num)), palette[state]);
  });
  picture.getContext("2d").putImageData(image, 0, 0);
  return Object.assign(packed, { states, picture });
}

const cell = (axis) => (axis.stop - axis.start) / (axis.num - 1);
/* A choice on an axis of a map; phases are told apart within one turn only. */
const onAxis = (axis) =>
  axis.name === "psi0" ? ((chosen.psi0 % (2 * Math.PI)) + 2 * Math.PI) % (2 * Math.PI) : Number(chosen[axis.name]);
/* What the cells of an axis cover: grid points are the middles of their cells. */
const reach = (axis) => [axis.start - 0.5 * cell(axis), axis.stop + 0.5 * cell(axis)];
const within = (axis) => onAxis(axis) >= reach(axis)[0] && onAxis(axis) <= reach(axis)[1];

/* Parameters in which the choice is not that of a map. Friction does not act on the vertical motion, nor on states. */
function differences(one) {
  return Object.keys(one.model).filter((name) => name !== "friction" && !same(chosen[name], one.model[name]));
}

/* State at the grid point nearest to the start, or nothing outside the map. */
function stateOnMap(one) {
  if (!within(one.x) || !within(one.y)) return undefined;
  const [column, row] = [one.x, one.y].map((axis) => Math.round((onAxis(axis) - axis.start) / cell(axis)));
  return data.states[one.states[Math.min(row, one.y.num - 1) * one.x.num + Math.min(column, one.x.num - 1)]];
}

function mapTitle(one) {
  const { acceleration } = one.model;
  const fixed = acceleration === undefined ? "" : `, at ${shownAs("acceleration", acceleration)}`;
  return `${CONTROLS[one.x.name].label} and ${inText(one.y.name)}${fixed}`;
}

/* Move the start to a place of the map, on the map's own conveyor. */
function moveTo(x, y) {
  const inside = (axis, value) => plain(Math.min(Math.max(value, axis.start), axis.stop));
  choose({ ...map.model, friction: chosen.friction, [map.x.name]: inside(map.x, x), [map.y.name]: inside(map.y, y) });
}

function showMap() {
  const other = differences(map);
  const [xControl, yControl] = [CONTROLS[map.x.name], CONTROLS[map.y.name]];
  mapFrame = frame(mapCanvas, reach(map.x), reach(map.y));
  const { context, left, top, width, height } = mapFrame;
  context.imageSmoothingEnabled = false;
  context.globalAlpha = other.length ? 0.3 : 1;
  context.drawImage(map.picture, left, top, width, height);
  context.globalAlpha = 1;
  axes(mapFrame, `${inText(map.x.name)} in ${xControl.unit}`, `${inText(map.y.name)} in ${yControl.unit}`, {
    xFactor: xControl.factor,
    yFactor: yControl.factor,
  });
  if (within(map.x) && within(map.y)) {
    const [x, y] = [mapFrame.x(onAxis(map.x)), mapFrame.y(onAxis(map.y))];
    context.save();
    context.beginPath();
    context.rect(left, top, width, height);
    context.clip();
    for (const [colour, width] of [["#ffffff", 4], ["#000000", 1.5]]) {
      context.strokeStyle = colour;
      context.lineWidth = width;
      context.beginPath();
      context.arc(x, y, 4, 0, 2 * Math.PI);
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        context.moveTo(x + 4 * dx, y + 4 * dy);
        context.lineTo(x + 16 * dx, y + 16 * dy);
      }
      context.stroke();
    }
    context.restore();
  }
  const place = ({ name }) => `${inText(name)} ${shownAs(name, chosen[name])}`;
  const start = `${place(map.x)}, ${place(map.y)}`;
  const state = stateOnMap(map);
  const subject = other.every((name) => ["psi0", "z0", "vz0"].includes(name)) ? "start" : "conveyor";
  const names = other.map((name) => {
    const [wanted, given] = [map.model, chosen].map((values) => shownAs(name, values[name]));
    return `${inText(name)} ${wanted} instead of ${given}`;
  });
  byId("map-other").hidden = byId("map-take").hidden = !other.length;
  byId("map-other").textContent = `not of this ${subject}`;
  byId("map-here").textContent = other.length
    ? `These states are not of this ${subject}, but of ${names.join(", ")}. A click or an arrow key takes that over.`
    : state
      ? `${start}: ${STATE_NAMES[state].toLowerCase()}`
      : `${start}: outside the map`;
  byId("map-axes").textContent = `${mapTitle(map)}${other.length ? `, not of this ${subject}` : ""}`;
}

/* The map that is shown from now on. */
function showOnMap(one) {
  map = one;
  byId("map-choice").value = maps.indexOf(one);
  showMapLegend();
}

function showMapLegend() {
  const count = (state) => map.states.filter((code) => data.states[code] === state).length;
  const occurring = data.states.map((state) => [state, count(state)]).filter(([, points]) => points);
  byId("map-legend").replaceChildren(
    ...occurring.map(([state, points]) => {
      const swatch = element("span", { className: "swatch" });
      swatch.style.background = colours[state];
      const few = points < FEW ? ` (${points} of ${map.states.length} points)` : "";
      return element("span", {}, swatch, STATE_NAMES[state].toLowerCase() + few);
    }),
  );
}

function clickMap(event) {
  const { left, top, width, height } = mapFrame;
  const box = mapCanvas.getBoundingClientRect();
  const along = (axis, share) => axis.start + Math.round(share * axis.num - 0.5) * cell(axis);
  const x = along(map.x, (event.clientX - box.left - left) / width);
  moveTo(x, along(map.y, 1 - (event.clientY - box.top - top) / height));
}

function steerMap(event) {
  const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
  if (!steps || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  const cells = event.shiftKey ? 10 : 1;
  const at = (axis) => (Number.isFinite(onAxis(axis)) ? onAxis(axis) : axis.start);
  moveTo(at(map.x) + steps[0] * cells * cell(map.x), at(map.y) + steps[1] * cells * cell(map.y));
}

// ------------------------------------------------------------------------------------------------------- results

function showResults() {
  const ok = run.status === "ok";
  const swatch = element("span", { className: "swatch" });
  swatch.style.background = ok && stated.name ? colours[stated.name] : "transparent";
  byId("state").replaceChildren(swatch, stated.text, element("small", { textContent: stated.note }));
  // Where rounding decides the impacts, so it does the velocity: then it is that of one run among many.
  const sharp = ok && known === run.impacts().length;
  const meanOf = (one) => `${signed(digits(one.meanVelocity(data.last), sharp ? 7 : 2))} m/s`;
  const mean = ok ? meanOf(run) : "not known";
  const doubt = sharp || !ok ? "" : "of this run: rounding decides";
  byId("velocity").replaceChildren(mean, element("small", { textContent: doubt }));
  byId("twin-result").hidden = !twin;
  byId("twin-velocity").textContent = twin ? meanOf(twin) : "";
  byId("count").textContent = ok ? `${run.impacts().length} in ${duration} s` : "not known";
  byId("euler-result").hidden = !byId("euler").checked;
  byId("euler-velocity").textContent = eulerText();
  byId("summary").textContent = `${stated.text}, ${mean}`;
  // A screen reader hears the result when the sliders rest, and not of every one on the way.
  later("announcement", 600, () => {
    const place = document.activeElement === mapCanvas ? `${byId("map-here").textContent}. ` : "";
    byId("announcement").textContent = `${place}${stated.text}. Mean feeding velocity ${mean}.`;
  });
}

/* Whether there is a curve of Euler's: not of one that has blown up. */
const eulerDrawn = () => eulerRun && eulerRun.status === "ok";

function eulerText() {
  if (!eulerRun) return "computing …";
  if (!eulerDrawn()) return eulerRun.status;
  const [found, exact] = [eulerRun, run].map((one) => one.meanVelocity(data.last));
  const deviation = Math.abs(exact) > 1e-9 ? ` (${signed(digits((100 * (found - exact)) / exact, 2))} %)` : "";
  return `${signed(digits(found, 7))} m/s${deviation}`;
}

function showImpacts() {
  const impacts = run.impacts();
  const rows = impacts.slice(0, ROWS).map(({ time, speed, flight }, k) => {
    const phase = (run.c.omega * time + run.c.psi0) % (2 * Math.PI);
    const [approach, before] = [speed, 1e3 * flight].map((one) => one.toPrecision(6));
    const texts = [String(k + 1), time.toFixed(12), phase.toFixed(6), approach, before];
    const cells = texts.map((textContent) => element("td", { textContent: signed(textContent) }));
    return element("tr", { className: k < known ? "" : "blurred" }, ...cells);
  });
  byId("impacts").replaceChildren(...rows);
  const notes = [];
  if (impacts.length > ROWS) notes.push(`The first ${ROWS} of ${impacts.length} are listed.`);
  if (known < impacts.length) {
    const moved = `a start ${power10(Math.log10(BLUR))} m higher moves these times by more than ${1e6 * SHARP} µs`;
    notes.push(`From No. ${known + 1} on rounding decides: ${moved}.`);
  }
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

// ------------------------------------------------------------------------------------------------------- drawing

const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/* The canvas made empty at the resolution of the screen, with its plot area and the scales of both axes. */
function frame(canvas, xRange, yRange, log = false) {
  const ratio = window.devicePixelRatio || 1;
  const { clientWidth, clientHeight } = canvas;
  canvas.width = Math.round(clientWidth * ratio);
  canvas.height = Math.round(clientHeight * ratio);
  const context = canvas.getContext("2d");
  context.scale(ratio, ratio);
  context.font = "12px system-ui, sans-serif";
  const [left, top] = [52, 24];
  const [width, height] = [clientWidth - left - 18, clientHeight - top - 38];
  const x = (value) => left + ((value - xRange[0]) / (xRange[1] - xRange[0])) * width;
  const y = log
    ? (value) => top + height - (Math.log10(value / yRange[0]) / Math.log10(yRange[1] / yRange[0])) * height
    : (value) => top + height - ((value - yRange[0]) / (yRange[1] - yRange[0])) * height;
  return { context, left, top, width, height, x, y, xRange, yRange, log };
}

/* About `count` round numbers between two others. */
function ticks(low, high, count) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((one) => one >= rough);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(plain(k * step));
  return found;
}

function axes(shape, xLabel, yLabel, { xFactor = 1, yFactor = 1 } = {}) {
  const { context, left, top, width, height, xRange, yRange, log } = shape;
  context.lineWidth = 1;
  context.fillStyle = style("soft");
  context.strokeStyle = style("line");
  context.strokeRect(left + 0.5, top + 0.5, width - 1, height - 1);
  context.textAlign = "center";
  context.textBaseline = "top";
  for (const tick of ticks(xRange[0] * xFactor, xRange[1] * xFactor, Math.max(3, width / 60))) {
    const x = shape.x(tick / xFactor);
    context.fillRect(x - 0.5, top + height, 1, 4);
    context.fillText(signed(String(tick)), x, top + height + 6);
  }
  context.fillText(xLabel, left + width / 2, top + height + 22);
  context.textAlign = "right";
  context.textBaseline = "middle";
  const [low, high] = yRange.map((value) => (log ? Math.log10(value) : value * yFactor));
  for (const tick of ticks(low, high, Math.max(2, height / 30))) {
    if (log && !Number.isInteger(tick)) continue;
    const y = shape.y(log ? 10 ** tick : tick / yFactor);
    context.fillRect(left - 4, y - 0.5, 4, 1);
    context.fillText(log ? power10(tick) : signed(String(tick)), left - 7, y);
  }
  context.textAlign = "left";
  context.textBaseline = "bottom";
  context.fillText(yLabel, 4, top - 7);
}

const raised = (sign) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(sign)];
const power10 = (exponent) => `10${String(exponent).replace(/./g, raised)}`;

/* Curves within the plot area; a NaN interrupts one. */
function draw(shape, curves) {
  const { context, left, top, width, height } = shape;
  context.save();
  context.beginPath();
  context.rect(left, top, width, height);
  context.clip();
  for (const { xs, ys, look } of curves) {
    context.strokeStyle = look.colour;
    context.lineWidth = look.width;
    context.setLineDash(look.dash || []);
    context.beginPath();
    let pen = false;
    xs.forEach((x, k) => {
      if (Number.isNaN(ys[k])) pen = false;
      else if (pen) context.lineTo(shape.x(x), shape.y(ys[k]));
      else {
        context.moveTo(shape.x(x), shape.y(ys[k]));
        pen = true;
      }
    });
    context.stroke();
  }
  context.restore();
}

/* Looks of the curves: the part in the colour of its state. */
function looks() {
  return {
    plate: { colour: style("plate"), width: 3, label: "plate" },
    part: { colour: colours[stated.name] || style("ink"), width: 2, label: "part" },
    twin: { colour: style("ink"), width: 1.5, dash: [6, 3], label: "second part" },
    euler: { colour: data.euler, width: 1.5, dash: [2, 3], label: "paper’s Euler" },
  };
}

function showLegend(look) {
  const shown = [look.part, look.plate, ...(twin ? [look.twin] : []), ...(eulerDrawn() ? [look.euler] : [])];
  const entries = shown.map(({ colour, width, dash, label }) => {
    const line = element("span", { className: "line" });
    line.style.borderTop = `${width}px ${dash ? "dashed" : "solid"} ${colour}`;
    return element("span", {}, line, label);
  });
  byId("legend").replaceChildren(...entries);
}

/* How many samples a curve of a duration takes at so many to a cycle. */
const samples = (span, perCycle) => Math.min(20000, Math.max(900, Math.ceil((perCycle * span) / run.c.period)));

/* `count` times from one to another; and the middle and both ends of every piece of motion between them: forces jump
   there, and no impact is so short that a curve may miss it. */
function moments(from, to, count) {
  const times = Array.from({ length: count + 1 }, (_, k) => from + ((to - from) * k) / count);
  run.pieces.forEach(({ begin }, k) => {
    const end = k + 1 < run.pieces.length ? run.pieces[k + 1].begin : duration;
    for (const one of [begin, 0.5 * (begin + end), end - 1e-14]) if (one > from && one < to) times.push(one);
  });
  return times.sort((a, b) => a - b);
}

/* Smallest and largest of many numbers. */
function bounds(values) {
  return values.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
}

/* A range for an axis. What varies by rounding only gets a range in which it is constant. */
function rangeOf(values) {
  const [low, high] = bounds(values);
  const margin = Math.max(0.06 * (high - low), 1e-3 * Math.max(-low, high), 1e-9);
  return [low - margin, high + margin];
}

/* Ranges of all plots over the whole run, so that they stay while time goes on. */
function measureExtent() {
  const times = moments(0, duration, samples(duration, 100));
  const parts = times.map((one) => run.at(one));
  const plates = times.map((one) => solver.plate(run.c, one));
  const from = times.findIndex((one) => one >= (1 - data.last) * duration);
  extent = {
    velocity: rangeOf([...parts, ...plates].map(({ vx }) => vx)),
    height: rangeOf([...parts, ...plates].map(({ z }) => z)),
    contact: rangeOf(parts.map(({ contactForce }) => contactForce)),
    friction: rangeOf(parts.map(({ frictionForce }) => frictionForce)),
    last: parts.slice(from),
    lastPlates: plates.slice(from),
  };
}

function timeWindow() {
  const span = Math.min(Number(byId("cycles").value) * run.c.period, duration);
  const begin = Math.min(Math.floor(time / span + 1e-9) * span, duration - span);
  return [Math.max(begin, 0), Math.max(begin, 0) + span];
}

/* A plot of a quantity over the time in view. */
function drawSignal(id, name, label, scale, times, curves, view) {
  const canvas = byId(`plot-${id}`);
  const ranges = extent[id].map((one) => one * scale);
  const shape = frame(canvas, view.map((one) => 1e3 * one), ranges);
  axes(shape, "time t in ms", label);
  const xs = times.map((one) => 1e3 * one);
  draw(shape, curves.map(([values, look]) => ({ xs, ys: values.map((one) => scale * one[name]), look })));
  const [low, high] = bounds(times.map((one) => scale * run.at(one)[name])).map((one) => digits(one, 3));
  const [from, to] = view.map((one) => (1e3 * one).toFixed(1));
  canvas.setAttribute("aria-label", `${label}: from ${from} to ${to} ms between ${low} and ${high}`);
}

function drawSignals() {
  const view = timeWindow();
  drawnWindow = String(view);
  const times = moments(...view, samples(view[1] - view[0], 200));
  const look = looks();
  const of = (one) => times.map((moment) => one.at(moment));
  const plates = times.map((moment) => solver.plate(run.c, moment));
  const part = [of(run), look.part];
  // The second part lies beneath the first one, and comes into sight where they part.
  const parts = [...(twin ? [[of(twin), look.twin]] : []), part, ...(eulerDrawn() ? [[of(eulerRun), look.euler]] : [])];
  const ground = [plates, look.plate];
  drawSignal("velocity", "vx", "velocity ẋ in m/s", 1, times, [ground, ...parts], view);
  drawSignal("height", "z", "height z in mm", 1e3, times, [ground, ...parts], view);
  drawSignal("contact", "contactForce", "contact force in N", 1, times, parts, view);
  drawSignal("friction", "frictionForce", "friction force in N", 1, times, parts, view);
}

let phaseFrame;

function drawPhase() {
  const { last, lastPlates } = extent;
  const everything = [...last, ...lastPlates];
  const xs = rangeOf(everything.map(({ z }) => 1e3 * z));
  phaseFrame = frame(byId("plot-phase"), xs, rangeOf(everything.map(({ vz }) => vz)));
  axes(phaseFrame, "height z in mm", "velocity ż in m/s");
  const look = looks();
  const curve = (points, one) => ({ xs: points.map(({ z }) => 1e3 * z), ys: points.map(({ vz }) => vz), look: one });
  draw(phaseFrame, [curve(lastPlates, look.plate), curve(last, { ...look.part, width: 1.3 })]);
}

/* The distance of both parts in the plane of height and velocity, the latter over ω: a length. */
function drawDistance() {
  const canvas = byId("plot-distance");
  const count = samples(duration, 24);
  const times = Array.from({ length: count + 1 }, (_, k) => (k * duration) / count);
  // Parts that have become the same to the last digit have no place on the axis.
  const apart = times.map((one) => {
    if (!twin) return NaN;
    const [a, b] = [run.at(one), twin.at(one)];
    return Math.hypot(a.z - b.z, (a.vz - b.vz) / run.c.omega) || NaN;
  });
  const seen = apart.filter((one) => one > 0);
  const [low, high] = bounds(seen.length ? seen : [Number(byId("separation").value)]).map(Math.log10);
  const decades = [10 ** Math.floor(low), 10 ** (Math.floor(high) + 1)];
  const shape = frame(canvas, [0, 1e3 * duration], decades, true);
  axes(shape, "time t in ms", "distance in m");
  draw(shape, [{ xs: times.map((one) => 1e3 * one), ys: apart, look: { ...looks().part, width: 1.5 } }]);
  const [first, last] = [seen[0], seen.at(-1)].map((one) => digits(one || 0, 2));
  const text = twin ? `distance of both parts: ${first} m at first, ${last} m at last` : "no second part";
  canvas.setAttribute("aria-label", text);
  if (twin) return;
  shape.context.textAlign = "center";
  shape.context.fillText(text, shape.left + shape.width / 2, shape.top + shape.height / 2);
}

/* Another width or colour scheme: nothing is computed again. */
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

/* What moves with time: the part, the cursors of the plots, the readout. */
function drawMoment() {
  if (String(timeWindow()) !== drawnWindow) drawSignals();
  const [from, to] = timeWindow();
  const place = (id, share) => {
    const canvas = byId(id);
    canvas.nextElementSibling.style.left = `${52 + Math.min(Math.max(share, 0), 1) * (canvas.clientWidth - 70)}px`;
  };
  for (const id of ["velocity", "height", "contact", "friction"]) place(`plot-${id}`, (time - from) / (to - from));
  place("plot-distance", time / duration);
  const part = run.at(time);
  const dot = byId("plot-phase").nextElementSibling;
  dot.style.left = `${phaseFrame.x(1e3 * part.z)}px`;
  dot.style.top = `${phaseFrame.y(part.vz)}px`;
  const slider = byId("time");
  slider.value = time;
  slider.setAttribute("aria-valuetext", `${(1e3 * time).toFixed(1)} ms`);
  drawScene();
  showReadout();
}

/* Plate and part from the side, both axes to one scale; the view goes along with the part. */
function drawScene() {
  const canvas = byId("scene");
  const [low, high] = extent.height;
  const radius = 0.09 * (high - low);
  const margin = 0.3 * (high - low);
  const span = high + 2 * radius - low + margin;
  const ratio = (canvas.clientWidth - 70) / (canvas.clientHeight - 62);
  const { period } = run.c;
  const xAt = (one) => run.at(Math.min(Math.max(one, 0), duration)).x;
  const centre = 0.5 * (xAt(time - 0.5 * period) + xAt(time + 0.5 * period));
  const xRange = [centre - 0.5 * ratio * span, centre + 0.5 * ratio * span];
  const shape = frame(canvas, xRange, [low - margin, high + 2 * radius]);
  const { context } = shape;
  const ground = solver.plate(run.c, time);
  const look = looks();
  context.save();
  context.beginPath();
  context.rect(shape.left, shape.top, shape.width, shape.height);
  context.clip();

  // The plate, with marks that move with it.
  context.fillStyle = style("plate");
  context.fillRect(shape.left, shape.y(ground.z), shape.width, shape.height);
  context.fillStyle = style("paper");
  const every = ticks(...xRange, 8);
  const spacing = every[1] - every[0];
  for (let k = Math.floor((xRange[0] - ground.x) / spacing); k * spacing + ground.x < xRange[1]; k++) {
    context.fillRect(shape.x(k * spacing + ground.x) - 1, shape.y(ground.z) + 3, 2, 12);
  }

  // The path of the last two cycles, then both parts: each touches the plate with its lowest point.
  const past = moments(Math.max(0, time - 2 * period), time, 160);
  const path = past.map((one) => run.at(one));
  draw(shape, [{ xs: path.map(({ x }) => x), ys: path.map(({ z }) => z), look: { ...look.part, width: 1 } }]);
  const pixels = shape.y(0) - shape.y(radius);
  const ball = (part, fill, stroke) => {
    context.beginPath();
    context.arc(shape.x(part.x), shape.y(part.z) - pixels, pixels, 0, 2 * Math.PI);
    if (fill) {
      context.fillStyle = fill;
      context.fill();
    }
    context.strokeStyle = stroke;
    context.lineWidth = 2;
    context.setLineDash(fill ? [] : [4, 3]);
    context.stroke();
    context.setLineDash([]);
  };
  ball(run.at(time), look.part.colour, style("ink"));
  if (twin) ball(twin.at(time), undefined, style("ink"));
  context.restore();
  axes(shape, "position x in mm", "height z in mm", { xFactor: 1e3, yFactor: 1e3 });
}

// ----------------------------------------------------------------------------------------------------- animation

const calm = matchMedia("(prefers-reduced-motion: reduce)");
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

// -------------------------------------------------------------------------------------------------------- set-up

function fill(select, values, text, value) {
  select.replaceChildren(...values.map((one) => element("option", { value: one, textContent: text(one) })));
  select.value = value;
}

function setUp() {
  Object.entries(CONTROLS).forEach(addControl);
  maps.forEach(unpackMap);
  const presets = Object.entries(data.presets).map(([name, values]) => [name, { ...model, ...values }]);
  for (const [name, values] of presets) {
    const swatch = element("span", { className: "swatch" });
    swatch.style.background = colours[name] || "transparent";
    const button = element("button", { type: "button" }, swatch, STATE_NAMES[name] || name);
    button.addEventListener("click", () => chooseAll(values));
    byId("presets").append(button);
  }
  fill(byId("map-choice"), [...maps.keys()], (k) => mapTitle(maps[k]), 0);
  fill(byId("slow"), SLOWNESS, (one) => `${one} ×`, 100);
  fill(byId("separation"), SEPARATIONS, (one) => `${power10(Math.round(Math.log10(one)))} m`, data.separation);
  fill(byId("cycles"), CYCLES_IN_VIEW, (one) => (one === Infinity ? "all" : one), 4);
  byId("duration").value = duration;
  byId("euler-step").textContent = `${plain(1e6 * data.solver.step)} µs`;

  byId("on-plate").addEventListener("change", (event) => {
    choose({ z0: event.target.checked ? "conveyor" : plain(plateAtStart()) });
  });
  byId("tension").addEventListener("change", (event) => choose({ tension: event.target.value }));
  byId("map-choice").addEventListener("change", (event) => {
    showOnMap(maps[Number(event.target.value)]);
    showMap();
  });
  byId("map-take").addEventListener("click", () => moveTo(...[map.x, map.y].map((axis) => onAxis(axis) || axis.start)));
  mapCanvas.addEventListener("click", clickMap);
  mapCanvas.addEventListener("pointermove", (event) => {
    if (event.pointerType === "mouse" && event.buttons === 1) clickMap(event);
  });
  mapCanvas.addEventListener("keydown", steerMap);

  byId("play").addEventListener("click", () => play(!playing));
  byId("restart").addEventListener("click", () => goTo(0));
  byId("back").addEventListener("click", () => goTo(time - STEP * run.c.period));
  byId("forth").addEventListener("click", () => goTo(time + STEP * run.c.period));
  byId("next").addEventListener("click", () => {
    const next = run.impacts().find((impact) => impact.time > time + 1e-12);
    goTo(next ? next.time : duration);
  });
  byId("time").addEventListener("input", (event) => goTo(event.target.valueAsNumber));
  byId("cycles").addEventListener("change", drawAll);
  for (const id of ["second", "separation", "euler"]) byId(id).addEventListener("change", request);
  byId("duration").addEventListener("change", (event) => {
    const { value, min, max } = event.target;
    const right = Number(value) >= Number(min) && Number(value) <= Number(max);
    event.target.setAttribute("aria-invalid", String(!right));
    if (!right) return;
    duration = Number(value);
    time = Math.min(time, duration);
    request();
  });
  let width;
  new ResizeObserver(([{ contentRect }]) => {
    if (contentRect.width !== width) redraw();
    width = contentRect.width;
  }).observe(document.body);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  calm.addEventListener("change", () => play(!calm.matches));
  addEventListener("hashchange", takeAddress);
  takeAddress();
  showMapLegend();
  play(!calm.matches);
}

setUp();
