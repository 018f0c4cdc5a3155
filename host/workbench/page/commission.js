// Commissions an axis from its data sheet, as `axistool commission` does, for the page that has the command.
import { board } from "./board.js";
import { choice } from "./choice.js";
import { commands, onCommand, ownerKey } from "./command.js";
import { commandLine, el } from "./elements.js";
import { fileAddress } from "./exchange.js";
import { begin, isOpen, jobs, onJobs } from "./jobs.js";

/** Units of the box; the same for a linear drive. */
const kUnits = { travel: "mm", speed: "mm/s", volts: "V", time: "s" };
/** Values of the fields; they outlive the view. */
const wish = { axis: "", model: "", travel: "", speed: "", volts: "", time: "360", overtravel: "" };

function field(name, text, unit, help) {
  const input = el("input", { type: "number", min: "0", step: "any", value: wish[name], "aria-label": text, title: help, oninput: (event) => ((wish[name] = event.target.value), drawButton()) });
  return el("label", {}, text + " ", input, " " + unit);
}

const isWhole = () => wish.model && Object.keys(kUnits).every((name) => Number(wish[name]) > 0);
const latest = () => jobs.find((job) => job.request.do === "commission");
let drawButton = () => {};

function start() {
  const box = Object.entries(kUnits).map(([name, unit]) => name + "=" + Number(wish[name]) + unit).join(",");
  begin({ do: "commission", owner: ownerKey(), model: wish.model, axis: wish.axis, box, ...(wish.overtravel === "" ? {} : { overtravel_mm: Number(wish.overtravel) }) });
}

const carryOn = (job) => begin({ ...job.request, owner: ownerKey(), from: job.next });

/** The latest run: what it does, its result, or where it continues. */
function lastRun() {
  const job = latest();
  if (!job) return [];
  return [el("p", { id: "commission-state", role: "status" }, el("span", { className: "badge" }, job.state), " " + job.message),
    commandLine(job.command),
    el("div", { className: "row" },
      job.report ? el("a", { id: "commission-page", href: fileAddress(job.report), target: "_blank", rel: "noopener" }, "Result") : null,
      !isOpen(job) && job.next ? el("button", { type: "button", id: "commission-continue", disabled: !commands(), onclick: () => carryOn(job) }, "Continue at " + job.next) : null)];
}

/** @param {(() => void)[]} leaving what to call when the view is left */
export function commissionPanel(leaving) {
  const sheets = choice.files.filter((file) => file.kind === "sheet" || file.kind === "model").map((file) => file.name);
  if (!sheets.includes(wish.model)) wish.model = choice.files.find((file) => file.kind === "sheet")?.name || "";
  if (!board.axes.some((one) => one.name === wish.axis)) wish.axis = board.axes[0]?.name || "";
  const run = el("div"), button = el("button", { type: "button", id: "commission-start", className: "primary", onclick: start }, "Commission the axis");
  const fields = el("div", { className: "row focus" });
  drawButton = () => (button.disabled = !commands() || !isWhole() || isOpen(latest() || { state: "" }));
  const drawFields = () => fields.replaceChildren(
    el("label", {}, "Axis ", el("select", { "aria-label": "Axis to commission", onchange: (event) => ((wish.axis = event.target.value), drawFields()) }, ...board.axes.map((one) => el("option", { value: one.name, selected: one.name === wish.axis }, one.name)))),
    el("label", {}, "Data sheet ", el("select", { "aria-label": "Data sheet", onchange: (event) => ((wish.model = event.target.value), drawButton()) }, el("option", { value: "" }, "–"), ...sheets.map((name) => el("option", { value: name, selected: name === wish.model }, name)))),
    field("travel", "Travel", kUnits.travel, "Width of the window around the initial position"), field("speed", "Speed", kUnits.speed, "Highest speed"),
    field("volts", "Command", kUnits.volts, "Largest command in open loop"), field("time", "Motion", kUnits.time, "Time of all motions together"),
    field("overtravel", "Free beyond the travel", kUnits.travel, "On each side, up to the hard stops; empty: unknown"));
  const draw = () => {
    drawButton();
    run.replaceChildren(...lastRun());
  };
  drawFields();
  draw();
  leaving.push(onCommand(draw), onJobs(draw));
  return el("details", { id: "commission", open: Boolean(latest()) }, el("summary", {}, "Commission an axis from its data sheet"),
    el("p", {}, "The axis moves within this box by itself for some minutes; the board enforces the box. Clear the travel. STOP, the space bar, or leaving this page stops the axis; the run then continues at the same step."),
    fields, el("div", { className: "row" }, button, el("span", { className: "soft" }, "Needs the command.")), run);
}
