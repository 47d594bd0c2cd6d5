/* Plots over time, the phase portrait and the distance of both parts. */

let extent; // ranges of the run's plots, see `measureExtent`
let drawnWindow = "";
let phaseFrame;

// Space around the plot area, in pixels, for ticks and labels.
const MARGIN = { left: 68, right: 18, top: 24, bottom: 38 };

const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/* Clear a canvas at the resolution of the screen; its plot area and the scales of both axes. */
function frame(canvas, xRange, yRange, log = false) {
  const ratio = window.devicePixelRatio || 1;
  const { clientWidth, clientHeight } = canvas;
  canvas.width = Math.round(clientWidth * ratio);
  canvas.height = Math.round(clientHeight * ratio);
  const context = canvas.getContext("2d");
  context.scale(ratio, ratio);
  context.font = "12px system-ui, sans-serif";
  const { left, top } = MARGIN;
  const [width, height] = [clientWidth - left - MARGIN.right, clientHeight - top - MARGIN.bottom];
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

/* The number at a tick; a long one with a power of ten, so that it fits beside the axis. */
function tickText(tick) {
  const text = String(tick);
  return signed(text.length > 7 ? tick.toExponential() : text);
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
    context.fillText(tickText(tick), x, top + height + 6);
  }
  context.fillText(xLabel, left + width / 2, top + height + 22);
  context.textAlign = "right";
  context.textBaseline = "middle";
  const [low, high] = yRange.map((value) => (log ? Math.log10(value) : value * yFactor));
  for (const tick of ticks(low, high, Math.max(2, height / 30))) {
    if (log && !Number.isInteger(tick)) continue;
    const y = shape.y(log ? 10 ** tick : tick / yFactor);
    context.fillRect(left - 4, y - 0.5, 4, 1);
    context.fillText(log ? power10(tick) : tickText(tick), left - 7, y);
  }
  context.textAlign = "left";
  context.textBaseline = "bottom";
  context.fillText(yLabel, 4, top - 7);
}

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

/* Styles of the curves: the part has the colour of its state. */
function looks() {
  return {
    plate: { colour: style("plate"), width: 3, label: "plate" },
    part: { colour: colours[stated.name] || style("ink"), width: 2, label: "part" },
    twin: { colour: style("ink"), width: 1.5, dash: [6, 3], label: "second part" },
    euler: { colour: data.euler, width: 1.5, dash: [2, 3], label: "paper's method (Euler)" },
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

/* Number of samples of a curve over a time span: all states that the run keeps, if they are few enough to draw. */
const samples = (span) => Math.min(20000, Math.max(900, Math.ceil(span / run.interval)));

/* `count` evenly spaced times. */
const moments = (from, to, count) => Array.from({ length: count + 1 }, (_, k) => from + ((to - from) * k) / count);

/* A range for an axis; a quantity that varies by rounding only appears constant in it. */
function rangeOf(values) {
  const [low, high] = bounds(values);
  const margin = Math.max(0.06 * (high - low), 1e-3 * Math.max(-low, high), 1e-9);
  return [low - margin, high + margin];
}

/* Ranges of all plots over the whole run, so that the axes do not change during the animation. */
function measureExtent() {
  const times = moments(0, duration, samples(duration));
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
  const times = moments(...view, samples(view[1] - view[0]));
  const look = looks();
  const of = (one) => times.map((moment) => one.at(moment));
  const plates = times.map((moment) => solver.plate(run.c, moment));
  const part = [of(run), look.part];
  // The second part lies beneath the first one, and becomes visible where they differ.
  const parts = [...(twin ? [[of(twin), look.twin]] : []), part, ...(eulerDrawn() ? [[of(eulerRun), look.euler]] : [])];
  const ground = [plates, look.plate];
  drawSignal("velocity", "vx", "velocity ẋ in m/s", 1, times, [ground, ...parts], view);
  drawSignal("height", "z", "height z in mm", 1e3, times, [ground, ...parts], view);
  drawSignal("contact", "contactForce", "contact force in N", 1, times, parts, view);
  drawSignal("friction", "frictionForce", "friction force in N", 1, times, parts, view);
}

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

/* Distance of both parts in the plane of z and ż/ω, a length. */
function drawDistance() {
  const canvas = byId("plot-distance");
  const times = moments(0, duration, samples(duration));
  // A distance of zero has no place on the logarithmic axis.
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
  const [first, last] = [apart[0], apart.at(-1)].map((one) => digits(one || 0, 2));
  const text = twin ? `distance of both parts: ${first} m at first, ${last} m at last` : "no second part";
  canvas.setAttribute("aria-label", text);
  if (twin) return;
  shape.context.textAlign = "center";
  shape.context.fillText(text, shape.left + shape.width / 2, shape.top + shape.height / 2);
}

/* The time of the animation in the plots, and its point in the phase portrait. */
function placeCursors() {
  const [from, to] = timeWindow();
  const place = (id, share) => {
    const canvas = byId(id);
    const width = canvas.clientWidth - MARGIN.left - MARGIN.right;
    canvas.nextElementSibling.style.left = `${MARGIN.left + Math.min(Math.max(share, 0), 1) * width}px`;
  };
  for (const id of ["velocity", "height", "contact", "friction"]) place(`plot-${id}`, (time - from) / (to - from));
  place("plot-distance", time / duration);
  const part = run.at(time);
  const dot = byId("plot-phase").nextElementSibling;
  dot.style.left = `${phaseFrame.x(1e3 * part.z)}px`;
  dot.style.top = `${phaseFrame.y(part.vz)}px`;
}
