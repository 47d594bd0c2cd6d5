/* Sliders and numbers for the parameters, the presets, and the choice in the page's address. */

// Label and unit of each parameter. `factor` converts from SI units to this unit, in which `low`, `high` and `step` of
// the slider are given; a `log` slider moves by decades. `automatic` is a value that follows from other parameters.
const DEGREES = 180 / Math.PI;
const CONTROLS = {
  acceleration: { label: "Amplitude â", unit: "m/s²", factor: 1, low: 0, high: 100, step: 0.1, main: true },
  z0: {
    ...{ label: "Initial height z₀", unit: "mm", factor: 1e3, low: -0.1, high: 1, step: 0.001, main: true },
    automatic: { value: "conveyor", label: "on the plate", resolve: () => plateHeight() },
  },
  psi0: { label: "Initial phase ψ₀", unit: "rad", factor: 1, low: 0, high: 6.28, step: 0.01, main: true },
  vz0: { label: "Initial velocity ż₀", unit: "m/s", factor: 1, low: -0.5, high: 0.5, step: 0.001 },
  frequency: { label: "Frequency f", unit: "Hz", factor: 1, low: 5, high: 200, step: 0.5 },
  angle: { label: "Angle of throw φ", unit: "°", factor: DEGREES, low: 0, high: 90, step: 0.5 },
  phase_shift: { label: "Phase shift ε along the track", unit: "°", factor: DEGREES, low: -180, high: 180, step: 1 },
  inclination: { label: "Inclination α of the track", unit: "°", factor: DEGREES, low: -20, high: 20, step: 0.1 },
  friction: { label: "Friction coefficient μ", unit: "", factor: 1, low: 0, high: 1, step: 0.01 },
  static_friction: {
    ...{ label: "Static friction coefficient μₛ", unit: "", factor: 1, low: 0, high: 1, step: 0.01 },
    automatic: { value: null, label: "equal to μ", resolve: () => chosen.friction },
  },
  damping: { label: "Contact damping", unit: "N s/m", factor: 1, low: 0, high: 2, step: 0.01 },
  stiffness: { label: "Contact stiffness", unit: "N/mᵖ", factor: 1, low: 3, high: 9, step: 0.05, log: true },
  exponent: { label: "Contact exponent p", unit: "", factor: 1, low: 1, high: 3, step: 0.05 },
  mass: { label: "Mass m", unit: "g", factor: 1e3, low: -2, high: 2, step: 0.02, log: true },
  gravity: { label: "Gravity g", unit: "m/s²", factor: 1, low: 0.1, high: 25, step: 0.01 },
};

/* A label within a sentence. */
const inText = (name) => (CONTROLS[name]?.label ?? name).replace(/^./, (letter) => letter.toLowerCase());

const isAutomatic = (name, value) => CONTROLS[name]?.automatic?.value === value;

function shownAs(name, value) {
  if (isAutomatic(name, value)) return CONTROLS[name].automatic.label;
  if (typeof value === "string") return value;
  const { factor, unit } = CONTROLS[name];
  return signed(`${digits(value * factor, 6)} ${unit}`.trim().replace(" °", "°"));
}

/* What is wrong with the value of a parameter among others, or nothing. */
function fault(name, values) {
  const value = values[name];
  if (isAutomatic(name, value)) return "";
  const [low, high] = ranges[name];
  if (!(Number.isFinite(value) && low <= value && value <= high)) {
    return `${CONTROLS[name].label} must be a number from ${shownAs(name, low)} to ${shownAs(name, high)}.`;
  }
  const { friction, static_friction: grip } = values;
  if (!name.includes("friction") || grip === null || grip >= friction) return "";
  return "The static friction coefficient μₛ must not be below the friction coefficient μ.";
}

function addControl([name, control]) {
  const { label, unit, factor, low, high, step, log, main, automatic } = control;
  const id = `parameter-${name}`;
  const number = element("input", { type: "number", id, step: "any" });
  const slider = element("input", { type: "range", min: low, max: high, step });
  const message = element("p", { className: "wrong", id: `${id}-wrong`, hidden: true });
  const tick = element("input", { type: "checkbox", id: `${id}-automatic` });
  slider.setAttribute("aria-label", label);
  tick.setAttribute("aria-label", `${label}: ${automatic?.label}`);
  number.setAttribute("aria-describedby", message.id);

  function take(value) {
    const wrong = fault(name, { ...chosen, [name]: value });
    message.textContent = wrong && `${wrong} The page keeps ${shownAs(name, chosen[name])}.`;
    message.hidden = !wrong;
    number.setAttribute("aria-invalid", String(Boolean(wrong)));
    if (!wrong) choose({ [name]: value });
  }
  number.addEventListener("change", () => take(number.value === "" ? NaN : number.valueAsNumber / factor));
  slider.addEventListener("input", () => {
    const value = log ? digits(10 ** slider.valueAsNumber, 3) : slider.valueAsNumber;
    take(plain(Number(value) / factor));
  });
  tick.addEventListener("change", () => take(tick.checked ? automatic.value : plain(automatic.resolve())));
  control.show = () => {
    tick.checked = isAutomatic(name, chosen[name]);
    const value = plain((tick.checked ? automatic.resolve() : chosen[name]) * factor);
    number.value = digits(value, tick.checked ? 4 : 7);
    number.disabled = slider.disabled = tick.checked;
    number.setAttribute("aria-invalid", "false");
    message.hidden = true;
    slider.value = log ? Math.log10(value) : value;
    slider.setAttribute("aria-valuetext", `${signed(number.value)} ${unit}`.trim());
  };
  const title = element("label", { htmlFor: id, textContent: label });
  const entry = element("span", { className: "entry" }, number, element("span", { className: "unit" }, unit));
  const box = element("div", { className: "control" }, title, slider, entry, message);
  if (automatic) box.append(element("label", { className: "check" }, tick, automatic.label));
  byId(main ? "main-controls" : "more-controls").append(box);
}

/* Height of the plate at the beginning of the run. */
function plateHeight() {
  return solver.plate(solver.constants(chosen), 0).z;
}

function choose(changes) {
  chosen = { ...chosen, ...changes };
  time = 0;
  request();
}

function showChoice() {
  for (const control of Object.values(CONTROLS)) control.show();
  byId("tension").value = chosen.tension;
  const changed = Object.keys(model).filter((name) => !same(chosen[name], model[name]) || name === "acceleration");
  const hash = changed.map((name) => `${name}=${chosen[name] ?? ""}`).join("&");
  // Browsers limit how often a page may change its address.
  later("hash", 500, () => history.replaceState(null, "", `#${hash}`));
}

/* Choose the values of a preset or of the address, and show a map of that conveyor if there is one. */
function chooseAll(values) {
  choose(values);
  if (differences(map).length) showOnMap(maps.find((one) => stateOnMap(one) && !differences(one).length) || map);
}

/* Take the choice from the address, as in #acceleration=80&z0=0, in SI units. An empty value stands for null. */
function takeAddress() {
  const pairs = [...new URLSearchParams(location.hash.slice(1))].map(([name, text]) => {
    if (text === "") return [name, null];
    return [name, Number.isNaN(Number(text)) ? text : Number(text)];
  });
  const values = { ...model, ...Object.fromEntries(pairs) };
  const right = ([name, value]) =>
    name === "tension" ? solver.TENSIONS.includes(value) : name in CONTROLS && !fault(name, values);
  const wrong = pairs.find((pair) => !right(pair));
  byId("address").textContent = wrong
    ? `The page cannot use ${wrong[0]} = ${wrong[1] ?? ""} from its address, and shows the defaults instead.`
    : "";
  byId("address").hidden = !wrong;
  const opening = { ...model, ...data.presets[data.opening] };
  chooseAll(wrong ? model : pairs.length ? values : opening);
}

function addPreset([name, values]) {
  const title = STATE_NAMES[name] || name.replaceAll("_", " ").replace(/^./, (letter) => letter.toUpperCase());
  const button = element("button", { type: "button" }, ...(colours[name] ? [swatch(colours[name])] : []), title);
  button.addEventListener("click", () => chooseAll({ ...model, ...values }));
  byId("presets").append(button);
}
