// The live view: channels of the board as they come, the trigger, motion and parameters.
import { board, closeStream, lookAtBoard, onBoard, state, stream } from "./board.js";
import { showParameters } from "./board_parameters.js";
import { giveRoles, loadFolder } from "./choice.js";
import { commissionPanel } from "./commission.js";
import { commandLine, el, notice } from "./elements.js";
import { post } from "./exchange.js";
import { motionPanel } from "./motion.js";
import { Scope } from "./scope.js";

/** Spans of the view, and rows of a bucket at 1 kHz. Buckets of 500 rows and more are kept for hours. */
const kSpans = [["2 s", 2, 2], ["10 s", 10, 10], ["1 min", 60, 50], ["10 min", 600, 500], ["1 h", 3600, 3000], ["8 h", 28800, 25000]];
let span = 1;
/** @type {Scope|null} */
let scope = null;
/** @type {[number, number]|null} rows of a paused view */
let paused = null;
let epoch = 0;
/** @type {(() => void)[]} */
let leaving = [];

const short = (value) => (value === null || value === undefined || !isFinite(value) ? "–" : String(Number(value.toPrecision(6))));

/** Ends what the view does while it is shown. */
export function leaveLive() {
  leaving.forEach((end) => end());
  leaving = [];
  scope = null;
  if (board.device) stream(0, 0, () => {}); // states only, for the other views
}

function run() {
  paused = null;
  const rows = /** @type {number} */ (kSpans[span][2]), buckets = Math.round(/** @type {number} */ (kSpans[span][1]) / board.period_s / rows);
  scope.begin(rows, buckets);
  epoch = board.epoch;
  stream(rows, rows * buckets, (told) => {
    if (!paused && told.epoch === epoch) scope?.add(told);
  });
}

/** Shows rows as they are kept, in more detail the fewer they are.
 * @param {number} from
 * @param {number} to
 */
async function pauseAt(from, to) {
  paused = [Math.max(0, Math.floor(from)), Math.ceil(to)];
  try {
    const told = await post("/api/live/rows", { epoch, from: paused[0], to: paused[1] });
    if (!paused || !scope) return;
    scope.begin(told.rows, Math.max(1, told.taken.length));
    scope.add(told);
  } catch (error) {
    notice(error.message);
  }
}

function pauseOrGoOn() {
  paused ? run() : pauseAt(scope.from, scope.to);
  drawTools();
}

/** @type {HTMLElement} */
let tools;
function drawTools() {
  const spans = el("div", { className: "segments", role: "group", "aria-label": "Span" }, ...kSpans.map(([text], index) =>
    el("button", { type: "button", "aria-pressed": String(index === span && !paused), onclick: () => ((span = index), run(), drawTools()) }, String(text))));
  tools.replaceChildren(
    el("button", { type: "button", id: "pause", className: paused ? "primary" : "", title: "Key p", onclick: pauseOrGoOn }, paused ? "Go on" : "Pause"), spans,
    el("button", { type: "button", id: "save-shown", onclick: save }, "Save what is shown as a record"));
}

/** What follows from a record in the folder. */
function nextSteps(records) {
  const place = document.getElementById("saved");
  const open = () => giveRoles(Object.fromEntries(records.map((name) => [name, "train"]))).then(() => (location.hash = "#compare"));
  loadFolder().catch((error) => notice(error.message));
  place?.replaceChildren("In the folder: " + records.join(", ") + " ", el("button", { type: "button", className: "primary", id: "open-saved", onclick: open }, "Open in Compare"));
}

async function save() {
  const [from, to] = paused || [Math.max(0, scope.from), scope.to];
  try {
    nextSteps((await post("/api/live/save", { epoch, from, to })).records);
  } catch (error) {
    notice(error.message);
  }
}

/** Drag: zoom. Click: cursor A; with Shift: B. Double click: go on. */
function pointers(canvas) {
  let from = null;
  canvas.addEventListener("pointerdown", (event) => {
    from = scope.rowAt(event.clientX);
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (from === null) return;
    scope.selection = [from, scope.rowAt(event.clientX)];
    scope.due();
  });
  canvas.addEventListener("pointerup", (event) => {
    if (from === null) return;
    const to = scope.rowAt(event.clientX), isClick = Math.abs(to - from) < 0.01 * (scope.to - scope.from);
    scope.selection = null;
    if (isClick) scope.cursors[event.shiftKey ? "b" : "a"] = to;
    else pauseAt(Math.min(from, to), Math.max(from, to)).then(drawTools);
    from = null;
    scope.due();
    drawReadings();
  });
  canvas.addEventListener("dblclick", () => (run(), drawTools()));
  canvas.addEventListener("keydown", (event) => {
    const name = event.shiftKey ? "b" : "a", step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const before = scope.cursors[name] ?? (scope.from + scope.to) / 2;
    scope.cursors[name] = Math.min(scope.to - 1, Math.max(scope.from, before + step * Math.max(scope.rows, (scope.to - scope.from) / 200)));
    scope.due();
    drawReadings();
  });
}

/** @type {HTMLElement} */
let readings;
function drawReadings() {
  if (!scope) return;
  const { a, b } = scope.cursors, middle = (range) => (range ? (range[0] + range[1]) / 2 : null);
  const apart_s = a !== null && b !== null ? (b - a) * board.period_s : null;
  const head = ["channel", "now", "A", "B", "B − A"].map((text) => el("th", { scope: "col" }, text));
  const rows = scope.stream.names.map((name, channel) => {
    const now = middle(scope.at(channel, scope.to - 1)), at = [a, b].map((row) => (row === null ? null : middle(scope.at(channel, row))));
    const values = [now, ...at, at[0] !== null && at[1] !== null ? at[1] - at[0] : null];
    return el("tr", {}, el("th", { scope: "row" }, name + (scope.stream.units[channel] ? " [" + scope.stream.units[channel] + "]" : "")), ...values.map((value) => el("td", { className: "number" }, short(value))));
  });
  const times = el("tr", {}, el("th", { scope: "row" }, "time [s]"), el("td", { className: "number" }, short(scope.to * board.period_s)),
    ...[a, b].map((row) => el("td", { className: "number" }, row === null ? "–" : short(row * board.period_s))), el("td", { className: "number" }, apart_s === null ? "–" : short(apart_s) + (apart_s ? " (" + short(1 / Math.abs(apart_s)) + " Hz)" : "")));
  readings.replaceChildren(el("thead", {}, el("tr", {}, ...head)), el("tbody", {}, ...rows, times));
}

function channelChoice() {
  const chosen = new Set(board.streamed);
  const boxes = board.axes.map((axis) => el("fieldset", {}, el("legend", {}, "axis " + axis.name), ...board.channels.filter((one) => one.name.startsWith(axis.name + ".")).map((one) =>
    el("label", {}, el("input", { type: "checkbox", checked: chosen.has(one.name), onchange: (event) => (event.target.checked ? chosen.add(one.name) : chosen.delete(one.name)) }), one.name))));
  const take = () => post("/api/live/channels", { channels: [...chosen] }).catch((error) => notice(error.message));
  return el("details", { id: "channels" }, el("summary", {}, "Channels (" + board.streamed.length + " of " + board.most + " at most)"), el("div", { className: "row" }, ...boxes), el("button", { type: "button", onclick: take }, "Stream these"));
}

function triggerPanel() {
  const axis = el("select", { "aria-label": "Axis that is recorded" }, ...board.axes.map((one) => el("option", { value: one.name }, one.name)));
  const event = el("input", { type: "text", value: "x.position_error > 20um", "aria-label": "Trigger", size: 26 });
  event.setAttribute("list", "events");
  const events = el("datalist", { id: "events" }, ...["x.position_error > 20um", "x.velocity_estimate > 5mm/s", "x.motion", "x.fault", "any.fault", "x.now"].map((value) => el("option", { value })));
  const before = el("input", { type: "number", value: "0.1", min: "0", step: "any", "aria-label": "Seconds before it" }), after = el("input", { type: "number", value: "0.4", min: "0", step: "any", "aria-label": "Seconds after it" });
  const told = el("p", { className: "soft", id: "trigger-state", role: "status" });
  const place = el("div");
  const arm = async () => {
    try {
      place.replaceChildren(commandLine((await post("/api/live/trigger", { axis: axis.value, trigger: event.value, before_s: Number(before.value), after_s: Number(after.value) })).command));
    } catch (error) {
      notice(error.message);
    }
  };
  let phase = "idle";
  leaving.push(onBoard(() => {
    const now = state.trigger || { phase: "idle", text: "" };
    told.textContent = { idle: "", waiting: "Armed: the board records when it happens.", done: "Recorded.", failed: now.text }[now.phase];
    if (phase === "waiting" && now.phase === "done") nextSteps([now.text]);
    phase = now.phase;
  }));
  return el("details", { id: "trigger" }, el("summary", {}, "Trigger in the board, with what came before it"),
    el("div", { className: "row focus" }, el("label", {}, "Axis ", axis), el("label", {}, "when ", event, events), el("label", {}, "from ", before, " s before"), el("label", {}, "to ", after, " s after"),
      el("button", { type: "button", id: "arm", onclick: arm }, "Arm"), el("button", { type: "button", onclick: () => post("/api/live/trigger/cancel", {}) }, "Disarm")), told, place);
}

/** The key of the view. @param {string} key */
export function liveKey(key) {
  if (key === "p" && scope) pauseOrGoOn();
}

function startHelp(place) {
  place.replaceChildren(el("h1", {}, "Live"), el("p", { className: "lead" }, "No board: start the workbench with one."),
    el("p", {}, "With a board on USB:"), commandLine("axistool serve --device usb"),
    el("p", {}, "With a simulated board, which runs in another terminal:"), commandLine("axistool sim"), commandLine("axistool serve --sim"));
}

/** @param {Element} place */
export async function showLive(place) {
  leaveLive();
  if (!board.device) return startHelp(place);
  await lookAtBoard();
  const canvas = el("canvas", { className: "scope", tabIndex: 0, role: "img", "aria-label": "The channels over time; the table below has their values. Arrows move cursor A, with Shift B." });
  scope = new Scope(canvas, { names: board.streamed, units: board.streamed.map((name) => board.channels.find((one) => one.name === name)?.unit || ""), period_s: board.period_s });
  tools = el("div", { className: "row" });
  readings = el("table");
  const counts = el("span", { className: "soft", id: "counts", role: "status" });
  const problem = el("p", { className: "problem", id: "board-problem", role: "alert" });
  place.replaceChildren(el("div", { className: "row head" }, el("h1", {}, "Live"), el("span", { className: "soft" }, board.board || ""), counts), problem,
    motionPanel(leaving), tools,
    el("figure", { className: "scope-frame" }, canvas, el("p", { className: "soft" }, "Drag: zoom. Click: cursor A, with Shift: B. Double click: go on. Shaded: rows that were lost.")),
    el("p", { id: "saved", role: "status" }), el("div", { className: "scroll table" }, readings), channelChoice(), triggerPanel(), showParameters(leaving), commissionPanel(leaving));
  pointers(canvas);
  const redraw = () => scope?.due();
  window.addEventListener("resize", redraw);
  leaving.push(() => window.removeEventListener("resize", redraw));
  let isAgain = false;
  leaving.push(onBoard(() => {
    if (!scope) return;
    problem.textContent = state.message;
    counts.textContent = (state.connected ? "" : "not connected · ") + Math.round(state.end * board.period_s) + " s, " + state.end + " rows, " + state.lost + " lost" + (state.repeated ? ", " + state.repeated + " twice" : "");
    drawReadings();
    if (state.epoch === epoch || isAgain || !state.epoch) return;
    isAgain = true; // another stream: its channels or units may differ
    showLive(place).catch((error) => notice(error.message));
  }));
  run();
  drawTools();
  drawReadings();
}

/** For tests: what the scope has received. */
export const received = () => scope?.counts;
