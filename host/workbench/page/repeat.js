// The same motion of an axis before and after a design is set in the board, and the following error of both.
import { board, lookAtBoard, onBoard, state } from "./board.js";
import { claim, command, commands, onCommand } from "./command.js";
import { commandLine, el, notice, short } from "./elements.js";
import { post } from "./exchange.js";
import { forgetPlots, showPlot } from "./report_parts.js";

const kPath = "/api/live/motion";
/** Rows of one request: as many as the program sends without putting them into buckets. */
const kRows = 1500;
const kPatience_s = 60, kSettle_s = 0.3;
/** In this time the page hears that an axis starts anew, as it does after a change of its parameters. */
const kRestart_s = 0.6;
/** Part of the way at which a motion counts as begun or ended. */
const kEdge = 1e-3;

/** @typedef {{error: number[][], period_s: number}} Motion following errors of the ways out and back, um, row by row */
/** Of the axis and way in `wish`; they outlive the view.
 * @type {{before: Motion|null, after: Motion|null}} */
const taken = { before: null, after: null };
const wish = { axis: "", way: 20, isFree: false };

/** "mm" or "m". */
const unitOf = () => board.axes.find((one) => one.name === wish.axis)?.unit || "mm";
/** Channels of the stream with the motion: position and following error. */
const channels = () => ["x_", "x_err_"].map((name) => wish.axis + "." + name + unitOf());

/** The latest state of the axis. */
const now = () => state?.axes[board.axes.findIndex((one) => one.name === wish.axis)];

/** Waits for a condition of the board's state; ends with an error if it does not come, or if this page no longer
 * commands.
 * @param {() => boolean} holds
 * @param {string} what for the message
 */
function until(holds, what) {
  return new Promise((resolve, reject) => {
    const end = (/** @type {Error|null} */ error) => {
      clearTimeout(timer);
      leave();
      error ? reject(error) : resolve(null);
    };
    const timer = setTimeout(() => end(new Error("Not within " + kPatience_s + " s: " + what + ".")), 1000 * kPatience_s);
    const leave = onBoard(() => {
      if (!commands()) end(new Error("Ended: this page no longer commands the axes."));
      else if (now()?.fault) end(new Error(now().fault.name + ": " + now().fault.cause + ". Remedy: " + now().fault.remedy + "."));
      else if (holds()) end(null);
    });
  });
}

/** A command that was carried out. The user has been told why one was refused: the error has no message then. */
async function done(path, request) {
  if (!commands()) throw new Error("Ended: this page no longer commands the axes.");
  const told = await command(path, request);
  if (!told) throw new Error("");
  return told;
}

async function enable() {
  if (now()?.state === "enabled") return;
  await done(kPath, { do: "enable", axis: wish.axis });
  await until(() => now().state === "enabled", "axis " + wish.axis + " is enabled");
}

async function disable() {
  await done(kPath, { do: "disable", axis: wish.axis });
  await until(() => now().state === "ready", "axis " + wish.axis + " is off");
}

/** Two channels of the stream, row by row; null where a row was lost. */
async function rowsOf(names, from, to) {
  const places = names.map((name) => board.streamed.indexOf(name)), values = names.map(() => /** @type {(number|null)[]} */ ([]));
  for (let begin = from; begin < to; begin += kRows) {
    const told = await post("/api/live/rows", { epoch: board.epoch, from: begin, to: Math.min(to, begin + kRows) });
    places.forEach((place, k) => values[k].push(...told.low[place]));
  }
  return values;
}

/** Moves to a position; returns the following error, um, from the first moment of the motion to its rest.
 * @param {number} to position
 * @param {number} way that is expected, signed
 */
async function move(to, way) {
  if (state.epoch !== board.epoch) await lookAtBoard(); // another stream, as after a change of parameters
  const from = state.end;
  await done(kPath, { do: "move", axis: wish.axis, position: to });
  await until(() => now().at_rest && Math.abs(now().position - to) < 0.5 * Math.abs(way), "axis " + wish.axis + " rests at its target");
  const settled = state.end + Math.ceil(kSettle_s / board.period_s);
  await until(() => state.end > settled, "rows arrive");
  const um = unitOf() === "m" ? 1e6 : 1e3;
  const [position, error] = await rowsOf(channels(), from, settled);
  if (error.includes(null)) throw new Error("Rows of the motion were lost: repeat it.");
  // The error is reference minus position, so the sum is the reference, which is the same in every repetition.
  const passed = error.map((value, k) => ((/** @type {number} */ (value)) + (/** @type {number} */ (position[k])) - (to - way)) / way);
  const begin = passed.findIndex((share) => share > kEdge), end = passed.findIndex((share) => share > 1 - kEdge);
  if (begin < 0 || end < begin) throw new Error("The stream has no motion over this way.");
  return error.slice(begin, end + Math.ceil(kSettle_s / board.period_s)).map((value) => um * (/** @type {number} */ (value)));
}

/** There and back.
 * @param {number} start
 * @returns {Promise<Motion>}
 */
async function thereAndBack(start) {
  return { error: [await move(start + wish.way, wish.way), await move(start, -wish.way)], period_s: board.period_s };
}

/** @param {Motion} motion */
function figures(motion) {
  const all = motion.error.flat();
  return { rms: Math.hypot(...all) / Math.sqrt(all.length), largest: Math.max(...all.map(Math.abs)) };
}

/** Both motions in one picture, way by way.
 * @param {Motion} motion
 * @param {number[]} starts of the ways, s
 */
function curve(motion, starts, name, colour) {
  const x = [], y = [];
  motion.error.forEach((way, k) => {
    way.forEach((value, row) => (x.push(starts[k] + row * motion.period_s), y.push(value)));
    x.push(starts[k] + way.length * motion.period_s);
    y.push(null);
  });
  return { name, colour, style: "line", dashed: false, x, y };
}

/** @param {HTMLElement} place */
function drawResult(place) {
  const { before, after } = taken;
  forgetPlots(place);
  if (!before) return place.replaceChildren();
  const motions = after ? [before, after] : [before];
  const starts = [0, Math.max(...motions.map((one) => one.error[0].length * one.period_s))];
  const head = ["following error", "RMS [µm]", "largest [µm]"].map((text) => el("th", { scope: "col" }, text));
  const rows = motions.map((one, k) => {
    const { rms, largest } = figures(one);
    return el("tr", {}, el("th", { scope: "row" }, k ? "after" : "before"), el("td", { className: "number" }, short(rms)), el("td", { className: "number" }, short(largest)));
  });
  const frame = el("div"), colours = ["#b8450b", "#0072b2"];
  place.replaceChildren(
    el("div", { className: "scroll table" }, el("table", { id: "repeat-errors" }, el("thead", {}, el("tr", {}, ...head)), el("tbody", {}, ...rows))),
    el("figure", {}, el("figcaption", {}, el("strong", {}, "Following error of " + wish.axis + " over " + short(wish.way) + " " + unitOf() + " and back")), frame));
  showPlot(frame, { kind: "scatter", xLabel: "time since the motion began [s]", xUnit: "s", label: "following error [µm]", unit: "µm", logarithmic: false, logarithmicX: false, equal: false, large: false, series: motions.map((one, k) => curve(one, starts, k ? "after" : "before", colours[k])) });
}

/** The panel of the Loop view.
 * @param {() => string} parameters of the present design, as a file
 * @param {(() => void)[]} leaving what to call when the panel is removed
 */
export function repeatPanel(parameters, leaving) {
  if (!board.axes.some((one) => one.name === wish.axis)) wish.axis = board.axes[0].name;
  const result = el("div"), log = el("div"), who = el("span", { className: "soft", id: "repeat-state", role: "status" });
  let isBusy = false, start = NaN;

  const forget = () => {
    taken.before = taken.after = null;
    drawResult(result);
    update();
  };
  const axis = el("select", { "aria-label": "Axis that moves", onchange: (event) => ((wish.axis = event.target.value), (free.checked = wish.isFree = false), forget()) }, ...board.axes.map((one) => el("option", { value: one.name, selected: one.name === wish.axis }, one.name)));
  const way = el("input", { type: "number", step: "any", value: wish.way, "aria-label": "Way of the motion", onchange: (event) => ((wish.way = Number(event.target.value)), (free.checked = wish.isFree = false), forget()) });
  const free = el("input", { type: "checkbox", id: "way-is-free", checked: wish.isFree, onchange: (event) => ((wish.isFree = event.target.checked), update()) });
  const unit = el("span");
  const take = el("button", { type: "button", id: "repeat-claim", onclick: claim }, "Take the command");
  const first = el("button", { type: "button", id: "move-before", onclick: () => run(before) }, "Move and record");
  const second = el("button", { type: "button", id: "move-after", className: "primary", onclick: () => run(after) }, "Set the design, then repeat");

  function update() {
    const at = now(), isReady = commands() && !isBusy && at?.homed && wish.isFree && wish.way !== 0;
    unit.textContent = " " + unitOf() + " and back";
    take.hidden = commands();
    take.disabled = Boolean(state?.owner);
    first.disabled = !isReady;
    second.disabled = !isReady || !taken.before;
    if (!isBusy) who.textContent = !commands() ? "Motion needs the command." : !at?.homed ? "A move to a position needs a known home: home the axis in Live." : !wish.isFree ? "Confirm that the way is free." : "Space stops.";
  }

  async function run(work) {
    isBusy = true;
    who.textContent = "Moving. Space stops.";
    update();
    try {
      await work();
    } catch (error) {
      if (error.message) notice(error.message);
    }
    isBusy = false;
    drawResult(result);
    update();
  }

  async function before() {
    taken.before = taken.after = null;
    const missing = channels().filter((name) => !board.streamed.includes(name));
    if (missing.length) throw new Error("Stream " + missing.join(" and ") + " in Live first.");
    await enable();
    start = now().position;
    taken.before = await thereAndBack(start);
  }

  async function after() {
    const { values } = await post("/api/live/parameters/file", { text: parameters(), name: "design", axis: wish.axis });
    await disable();
    const told = await done("/api/live/parameters", { values });
    log.replaceChildren(commandLine(told.command));
    await new Promise((resolve) => setTimeout(resolve, 1000 * kRestart_s));
    await until(() => now().state === "ready", "axis " + wish.axis + " is ready with the design");
    await enable();
    await done(kPath, { do: "move", axis: wish.axis, position: start });
    await until(() => now().at_rest && Math.abs(now().position - start) < kEdge * Math.abs(wish.way), "axis " + wish.axis + " rests at its start");
    taken.after = await thereAndBack(start);
  }

  leaving.push(onBoard(update), onCommand(update));
  drawResult(result);
  update();
  return el("section", { className: "loop", "aria-label": "On the machine" }, el("h2", {}, "The same motion, before and after"),
    el("div", { className: "row focus" }, take, el("label", {}, "Axis ", axis), el("label", {}, "moves by ", way, unit)),
    el("p", {}, el("label", {}, free, " This way is free, and the axis may move there at its limits of speed and acceleration.")),
    el("div", { className: "row" }, first, second, who), log, result);
}
