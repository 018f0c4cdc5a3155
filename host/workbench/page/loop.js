// Designs a controller by hand: bandwidth and filters move, and margins, step and following error follow at once.
// Nothing is written before it is wished.
import { board } from "./board.js";
import { stageParameters } from "./board_parameters.js";
import { choice } from "./choice.js";
import { commandLine, el, errorBox, notice, short } from "./elements.js";
import { post } from "./exchange.js";
import { repeatPanel } from "./repeat.js";
import { forgetPlots, partsOf, sectionLinks, showBlocks } from "./report_parts.js";

/** Values of the controls; they outlive the view. */
const wish = { response: "model", fc: 30, zeta: 0.7, notch: false, notch_Hz: 100, notch_damping: 0.3, notch_depth: 0.1, low_pass: false, low_pass_Hz: 200 };
let asked = 0;
let timer = 0;
/** Parameters of the design that is shown, as a file. */
let designed = "";
/** @type {(() => void)[]} */
let leaving = [];

/** Ends what the view does while it is shown. */
export function leaveLoop() {
  leaving.forEach((end) => end());
  leaving = [];
}

function request(further = {}) {
  return {
    model: choice.model, response: [wish.response], fc: wish.fc, zeta: wish.zeta,
    ...(wish.notch ? { notch: [wish.notch_Hz, wish.notch_damping, wish.notch_depth] } : {}),
    ...(wish.low_pass ? { low_pass: [wish.low_pass_Hz, 0.7] } : {}), ...further,
  };
}

/** @param {Element} place */
export function showLoop(place) {
  const head = el("h1", {}, "Loop");
  if (!choice.model) return place.replaceChildren(head, el("p", { className: "lead" }, "A design needs a model: drop one (.toml), or identify one."));
  const result = el("div"), controls = el("section", { className: "loop", "aria-label": "Controller" });

  async function ask(further) {
    clearTimeout(timer);
    const mine = ++asked;
    result.classList.add("waiting");
    try {
      const told = await post("/api/loop", request(further));
      if (mine !== asked || !result.isConnected) return;
      if (further?.margin) adopt(told.document);
      draw(told);
      if (told.written) notice("In the folder: " + told.written);
    } catch (error) {
      if (mine === asked) result.replaceChildren(errorBox(error));
    } finally {
      if (mine === asked) result.classList.remove("waiting");
    }
  }

  /** Moves the controls to a design that was found. */
  function adopt(document) {
    wish.fc = Number(document.options.fc_Hz.toPrecision(4));
    const notch = document.filters.notch;
    wish.notch = Boolean(notch);
    if (notch) Object.assign(wish, { notch_Hz: Number(notch.f_Hz.toPrecision(4)), notch_damping: notch.damping, notch_depth: notch.depth });
    drawControls();
  }

  function draw(told) {
    designed = told.parameters;
    const parts = partsOf(told.report), scrolled = window.scrollY;
    result.style.minHeight = result.offsetHeight + "px";
    forgetPlots(result);
    const stage = board.device ? el("button", { type: "button", id: "stage", onclick: () => stageParameters(told.parameters, board.axes[0].name).then((count) => notice(count + " values are staged in Live.")).catch((error) => notice(error.message)) }, "Stage on the board") : "";
    result.replaceChildren(parts.verdict ? document.importNode(parts.verdict, true) : "",
      el("div", { className: "row" }, el("button", { type: "button", id: "write-parameters", onclick: () => ask({ write: true }) }, "Write the parameters into the folder"), stage), commandLine(told.command));
    const box = showBlocks(result, parts);
    result.insertBefore(sectionLinks([box]), box);
    result.style.minHeight = "";
    window.scrollTo(0, scrolled);
  }

  function slider(name, text, unit, min, max, step, isOn = true) {
    const shown = el("output", {}, short(wish[name]) + " " + unit);
    const moved = (event) => {
      wish[name] = Number(event.target.value);
      shown.textContent = short(wish[name]) + " " + unit;
      clearTimeout(timer);
      timer = setTimeout(ask, 120);
    };
    return el("label", { className: "slider" }, el("span", {}, text), el("input", { type: "range", min, max, step, value: wish[name], disabled: !isOn, "data-name": name, oninput: moved }), shown);
  }

  function toggle(name, text) {
    return el("label", {}, el("input", { type: "checkbox", checked: wish[name], "data-name": name, onchange: (event) => ((wish[name] = event.target.checked), drawControls(), ask()) }), " " + text);
  }

  function drawControls() {
    const names = [["model", "the model"], ...choice.files.filter((file) => file.kind === "response" || file.kind === "record").map((file) => [file.name, file.name])];
    if (!names.some(([name]) => name === wish.response)) wish.response = "model";
    const response = el("select", { "aria-label": "Response", onchange: (event) => ((wish.response = event.target.value), ask()) }, ...names.map(([value, text]) => el("option", { value, selected: value === wish.response }, text)));
    controls.replaceChildren(
      el("div", { className: "row" }, el("label", {}, "Response of ", response),
        el("button", { type: "button", id: "fastest", onclick: () => ask({ margin: 0.5 }) }, "As fast as a margin of 0.5 allows"),
        el("button", { type: "button", id: "fastest-notch", onclick: () => ask({ margin: 0.5, notch: "auto" }) }, "The same, with a notch")),
      el("div", { className: "sliders" }, slider("fc", "Bandwidth", "Hz", 3, 120, 0.5), slider("zeta", "Damping", "", 0.3, 1.2, 0.01),
        toggle("notch", "Notch"), slider("notch_Hz", "Frequency", "Hz", 5, 400, 1, wish.notch), slider("notch_damping", "Width", "", 0.05, 1, 0.01, wish.notch), slider("notch_depth", "Depth", "", 0.02, 0.9, 0.01, wish.notch),
        toggle("low_pass", "Low-pass"), slider("low_pass_Hz", "Frequency", "Hz", 20, 400, 1, wish.low_pass)));
  }

  forgetPlots();
  leaveLoop();
  drawControls();
  place.replaceChildren(head, el("p", { className: "lead" }, "“Before” has the same bandwidth without filters. Nothing is written until you wish it."), controls, board.device ? repeatPanel(() => designed, leaving) : "", result);
  ask();
}
