// Enables, jogs and homes the axes, for the page that has the command.
import { board, onBoard, state } from "./board.js";
import { claim, claimNumber, command, commands, onCommand, release } from "./command.js";
import { commandLine, el } from "./elements.js";

const kPath = "/api/live/motion";
/** @type {Map<string, number>} jog speeds by axis */
const speeds = new Map();

/** A button that acts while it is held, by pointer or by Enter. */
function heldButton(properties, text, begin, end) {
  let isHeld = false;
  const press = (event) => {
    if (isHeld || (event.key !== undefined && event.key !== "Enter")) return;
    event.preventDefault();
    isHeld = true;
    begin();
  };
  const release = () => {
    if (isHeld) end();
    isHeld = false;
  };
  const button = el("button", { type: "button", ...properties, onpointerdown: press, onkeydown: press, onkeyup: release, onblur: release }, text);
  for (const type of ["pointerup", "pointercancel", "pointerleave"]) button.addEventListener(type, release);
  return button;
}

/** @param {(() => void)[]} leaving what to call when the view is left */
export function motionPanel(leaving) {
  const box = el("section", { className: "motion", "aria-label": "Motion" }), last = el("div");
  const send = async (action, axis, rest = {}) => {
    const told = await command(kPath, { do: action, ...(axis ? { axis } : {}), ...rest });
    if (told?.command) last.replaceChildren(commandLine(told.command));
  };
  const halt = () => send("halt", "");
  const rows = board.axes.map((axis) => {
    if (!speeds.has(axis.name)) speeds.set(axis.name, Number((axis.velocity / 10).toPrecision(2)));
    const told = el("span", { className: "badge" }), where = el("span", { className: "where" }), fault = el("p", { className: "problem" });
    const speed = el("input", { type: "number", min: "0", step: "any", value: speeds.get(axis.name), "aria-label": "Jog speed of " + axis.name, onchange: (event) => speeds.set(axis.name, Math.abs(Number(event.target.value))) });
    const jog = (sign) => heldButton({ id: "jog-" + axis.name + (sign > 0 ? "-plus" : "-minus"), title: "Moves while it is held, also with Enter" }, sign > 0 ? "+ ▶" : "◀ −", () => send("jog", axis.name, { velocity: sign * speeds.get(axis.name) }), halt);
    const enable = el("button", { type: "button", id: "enable-" + axis.name, onclick: () => send("enable", axis.name) }, "Enable");
    const disable = el("button", { type: "button", id: "disable-" + axis.name, onclick: () => send("disable", axis.name) }, "Disable");
    const home = el("button", { type: "button", onclick: () => send("home", axis.name) }, "Home"), here = el("button", { type: "button", title: "The present place becomes home", onclick: () => send("home_here", axis.name) }, "Home is here");
    const target = el("input", { type: "number", step: "any", "aria-label": "Position to move " + axis.name + " to", onchange: () => update() });
    const go = el("button", { type: "button", id: "move-" + axis.name, title: "Moves to this position, once the axis is homed", onclick: () => send("move", axis.name, { position: Number(target.value) }) }, "Move to");
    const moves = [jog(-1), jog(1), axis.homes ? home : here];
    const update = () => {
      const now = state?.axes[board.axes.indexOf(axis)];
      if (!now) return [enable, disable, go, ...moves].forEach((button) => (button.disabled = true));
      const isEnabled = now.state === "enabled";
      told.textContent = now.state;
      told.className = "badge" + (now.fault ? " bad" : isEnabled ? " good" : "");
      where.textContent = (now.position === null ? "–" : now.position.toFixed(axis.unit === "m" ? 7 : 4) + " " + axis.unit) + (now.homing ? ", looks for home" : now.homed ? "" : " (not homed)");
      fault.textContent = now.fault ? now.fault.name + ": " + now.fault.cause + ". Remedy: " + now.fault.remedy + "." : "";
      enable.disabled = !commands() || now.state !== "ready";
      disable.disabled = !commands() || !/^(enabled|starting)/.test(now.state);
      moves.forEach((button) => (button.disabled = !commands() || !isEnabled));
      go.disabled = !commands() || !isEnabled || !now.homed || target.value === "";
    };
    return { update, element: el("div", { className: "axis" }, el("strong", {}, axis.name), told, where, enable, disable, el("span", { className: "row" }, moves[0], el("label", {}, speed, " " + axis.unit + "/s"), moves[1]), moves[2], el("span", { className: "row" }, go, el("label", {}, target, " " + axis.unit)), fault) };
  });
  const who = el("span", { className: "soft", id: "who", role: "status" });
  const take = el("button", { type: "button", id: "claim", className: "primary", onclick: claim }, "Take the command"), give = el("button", { type: "button", id: "release", onclick: release }, "Give it back");
  const clear = el("button", { type: "button", id: "clear-faults", onclick: () => send("clear_faults", "") }, "Clear faults");
  const update = () => {
    const owner = state?.owner || 0, isOther = owner > 0 && owner !== claimNumber();
    who.textContent = commands() ? "This page commands: hold a jog button to move. Space stops." : isOther ? "Another page commands; this one looks." : "Nobody commands from a page.";
    take.hidden = commands();
    take.disabled = isOther;
    give.hidden = clear.hidden = !commands();
    rows.forEach((row) => row.update());
  };
  leaving.push(onBoard(update), onCommand(update));
  box.append(el("div", { className: "row" }, take, give, clear, who), ...rows.map((row) => row.element), last);
  update();
  return box;
}
