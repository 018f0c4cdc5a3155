// Who commands the axes. This page does after claim(), and shows ten times a second that it is there; without that the
// board stops the axes. STOP works without the command.
import { board } from "./board.js";
import { el, notice } from "./elements.js";
import { post } from "./exchange.js";

const kBeat_ms = 100;
let key = "";
let number = 0;
let isBeating = false;
/** @type {Promise<any>} commands in their order: a halt never overtakes its jog */
let queue = Promise.resolve();
const listeners = new Set();

export const commands = () => key !== "";
/** For a job that needs the command. */
export const ownerKey = () => key;
/** The number of this page's claim, as in the board's state. */
export const claimNumber = () => number;

/** @param {() => void} listener called when this page takes or loses the command */
export function onCommand(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** @param {string} why for the user; empty: as wished */
function lose(why) {
  if (!key) return;
  key = "";
  if (why) notice(why);
  listeners.forEach((listener) => listener());
}

async function beat() {
  if (!key || isBeating) return;
  const mine = key;
  isBeating = true;
  try {
    await post("/api/live/beat", { owner: mine });
  } catch (error) {
    if (mine === key) lose("This page no longer commands the axes: " + error.message);
  } finally {
    isBeating = false;
  }
}

export async function claim() {
  try {
    const told = await post("/api/live/claim", {});
    key = told.owner;
    number = told.number;
    listeners.forEach((listener) => listener());
  } catch (error) {
    notice(error.message);
  }
}

/** Stops the axes and gives the command back. */
export async function release() {
  const mine = key;
  lose("");
  await post("/api/live/release", { owner: mine }).catch((error) => notice(error.message));
}

/** A request that needs the command, after all earlier ones.
 * @param {string} path
 * @param {any} request
 * @returns {Promise<any>} the answer; null if it was refused, which the user is told
 */
export function command(path, request) {
  const mine = key;
  if (!mine) return Promise.resolve(null); // for example a button that is let go after STOP
  queue = queue.then(() => post(path, { owner: mine, ...request }).catch((error) => (notice(error.message), null)));
  return queue;
}

/** Slows all axes down and switches them off, whoever moves them. */
export async function stop() {
  lose("");
  try {
    await post("/api/live/stop", {});
    notice("Stopped: the axes slow down, then they are switched off.");
  } catch (error) {
    notice("NOT STOPPED: " + error.message + " Press the emergency stop.");
  }
}

/** In a text that is being written a space is a space, unless this page commands the axes. */
const isWritten = (target) => !commands() && target.closest?.("input:not([type=radio]):not([type=checkbox]):not([type=range]), textarea, select");

function pressed(event) {
  if (event.code !== "Space" || isWritten(event.target)) return;
  event.preventDefault();
  event.stopImmediatePropagation();
  if (event.type === "keydown" && !event.repeat) stop();
}

/** The button that is on the screen in every view, and its key. */
export function stopButton() {
  for (const type of ["keydown", "keyup"]) window.addEventListener(type, pressed, { capture: true });
  setInterval(beat, kBeat_ms);
  const leave = () => {
    if (key) navigator.sendBeacon("/api/live/release", JSON.stringify({ owner: key }));
    lose("This page was not to be seen, so it has stopped the axes and given the command back.");
  };
  window.addEventListener("pagehide", leave);
  document.addEventListener("visibilitychange", () => document.hidden && leave());
  return el("button", { type: "button", id: "stop", title: "Stops all axes of " + board.device + " (space bar)", onclick: stop }, "STOP");
}
