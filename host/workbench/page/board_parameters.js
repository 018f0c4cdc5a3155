// Parameters of the board: staged on the page, then set all together or not at all.
import { board } from "./board.js";
import { command, commands, onCommand } from "./command.js";
import { commandLine, el, notice } from "./elements.js";
import { get, post } from "./exchange.js";

/** @type {Map<string, string>} staged values; they outlive the view */
const staged = new Map();
let filter = "";

/** Stages the values of a file of parameters; returns their number.
 * @param {string} text
 * @param {string} axis of the board
 */
export async function stageParameters(text, axis) {
  const told = await post("/api/live/parameters/file", { text, name: "design", axis });
  for (const [name, value] of Object.entries(told.values)) staged.set(name, value);
  return Object.keys(told.values).length;
}

/** @param {(() => void)[]} leaving what to call when the view is left */
export function showParameters(leaving) {
  /** @type {any[]} */
  let list = [];
  let undoable = 0;
  const table = el("tbody"), counts = el("span", { className: "soft", role: "status" }), last = el("div");
  const apply = el("button", { type: "button", id: "apply", className: "primary" }, "Apply"), undo = el("button", { type: "button", id: "undo-parameters" }, "Undo the last change"), keep = el("button", { type: "button", title: "So that they are there after power-off" }, "Save in the board");
  const discard = el("button", { type: "button", onclick: () => (staged.clear(), draw()) }, "Discard");

  function row(one) {
    const stage = (event) => {
      const value = event.target.value.trim(), isChanged = value !== "" && value !== one.value;
      isChanged ? staged.set(one.name, value) : staged.delete(one.name);
      line.className = isChanged ? "staged" : "";
      buttons();
    };
    const input = el("input", { type: "text", value: staged.get(one.name) ?? one.value, "aria-label": one.name, spellcheck: false, onchange: stage });
    const line = el("tr", { className: staged.has(one.name) ? "staged" : "" }, el("th", { scope: "row", title: one.doc }, one.name), el("td", {}, input), el("td", { className: "number" }, one.value), el("td", {}, one.unit === "1" ? "" : one.unit),
      el("td", {}, one.type === "toggle" ? "true, false" : one.minimum + " to " + one.maximum), el("td", { className: "number" }, one.initial), el("td", { className: "soft" }, one.any_time ? "" : "axes off"));
    return line;
  }

  function buttons() {
    apply.disabled = !commands() || !staged.size;
    undo.disabled = !commands() || !undoable;
    keep.disabled = !commands();
    discard.disabled = !staged.size;
    counts.textContent = staged.size + " staged" + (commands() ? "" : "; setting them needs the command");
  }

  function draw() {
    const shown = list.filter((one) => staged.has(one.name) || (filter ? one.name.includes(filter) : one.name.startsWith(board.axes[0]?.name + ".limits")));
    table.replaceChildren(...shown.slice(0, 60).map(row));
    buttons();
  }

  async function read() {
    const told = await get("/api/live/parameters");
    list = told.parameters;
    undoable = told.undo;
    draw();
  }

  const settled = () => setTimeout(() => read().catch((error) => notice(error.message)), 300); // the board is read again
  apply.addEventListener("click", async () => {
    const told = await command("/api/live/parameters", { values: Object.fromEntries(staged) });
    if (!told) return;
    last.replaceChildren(commandLine(told.command));
    staged.clear();
    settled();
  });
  undo.addEventListener("click", async () => (await command("/api/live/parameters/undo", {})) && settled());
  keep.addEventListener("click", async () => (await command("/api/live/parameters/keep", {})) && notice("Saved in the board."));

  const axis = el("select", { "aria-label": "Axis of the file" }, ...board.axes.map((one) => el("option", { value: one.name }, one.name)));
  const file = el("input", { type: "file", accept: ".toml", id: "parameter-file", className: "hidden", onchange: async (event) => {
    const [chosen] = event.target.files;
    try {
      const told = await post("/api/live/parameters/file", { text: await chosen.text(), name: chosen.name, axis: axis.value });
      for (const [name, value] of Object.entries(told.values)) if (list.find((one) => one.name === name)?.value !== value) staged.set(name, value);
      draw();
    } catch (error) {
      notice(error.message);
    }
  } });
  const search = el("input", { type: "search", value: filter, placeholder: "x.feedback", "aria-label": "Find parameters", oninput: (event) => ((filter = event.target.value), draw()) });
  leaving.push(onCommand(buttons));
  read().catch((error) => notice(error.message));
  const heads = ["parameter", "staged", "active", "unit", "range", "initial", "changes"].map((text) => el("th", { scope: "col" }, text));
  return el("details", { id: "parameters" }, el("summary", {}, "Parameters"),
    el("div", { className: "row focus" }, search, el("label", {}, "File for axis ", axis), el("button", { type: "button", onclick: () => file.click() }, "Stage a file…"), file, apply, discard, undo, keep, counts), last,
    el("div", { className: "scroll table" }, el("table", {}, el("thead", {}, el("tr", {}, ...heads)), table)));
}
