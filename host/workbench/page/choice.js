// The present selection, stored in the folder: one model, models to draw beside it, and the role of each record.
import { el, notice } from "./elements.js";
import { get, post, upload } from "./exchange.js";
import { begin } from "./jobs.js";

/** `accepted`: faults of the logs that the user has accepted on this page.
 * @type {{folder: string, files: {name: string, kind: string, bytes: number, role: string}[], model: string|null, beside: string[], roles: Object<string, string>, accepted: string[]}}
 */
export const choice = { folder: "", files: [], model: null, beside: [], roles: {}, accepted: [] };

const listeners = [];
/** @param {() => void} listener */
export function onChoice(listener) {
  listeners.push(listener);
}

const folderOf = (name) => name.slice(0, name.lastIndexOf("/") + 1);
const namesOf = (kind) => choice.files.filter((file) => file.kind === kind).map((file) => file.name);

/**
 * @param {string} role
 * @returns {string[]}
 */
export function recordsAs(role) {
  return namesOf("record").filter((name) => choice.roles[name] === role);
}

/** Training and validation records, for a request. */
export function chosenRecords() {
  return { train: recordsAs("train"), validate: recordsAs("judge") };
}

/** Initial roles: records beside the model are for training, or for validation if their name says so. Those of a
 * commissioning have the roles that they had there. */
function usualRole(name) {
  if (choice.model && folderOf(name) !== folderOf(choice.model)) return "off";
  return choice.files.find((file) => file.name === name)?.role || (isForJudging(name) ? "judge" : "train");
}

export async function loadFolder() {
  const told = await get("/api/folder");
  choice.folder = told.folder;
  choice.files = told.files;
  const kept = told.choice || {};
  const models = namesOf("model");
  choice.model = models.includes(kept.model) ? kept.model : models.includes(choice.model) ? choice.model : models[0] || null;
  choice.beside = (kept.beside || choice.beside).filter((name) => models.includes(name) && name !== choice.model);
  const records = namesOf("record");
  choice.roles = Object.fromEntries(records.map((name) => [name, (kept.roles || choice.roles)[name] || usualRole(name)]));
  if (!recordsAs("train").length && recordsAs("judge").length) choice.roles[recordsAs("judge")[0]] = "train";
  render();
}

async function changed() {
  render();
  listeners.forEach((listener) => listener());
  await post("/api/choice", chosen()).catch((error) => notice(error.message));
}

/** @param {string} name */
export async function workOn(name) {
  choice.model = name;
  choice.beside = choice.beside.filter((other) => other !== name);
  await changed();
}

/** Gives roles to new records.
 * @param {Object<string, string>} roles
 */
export async function giveRoles(roles) {
  Object.assign(choice.roles, roles);
  await post("/api/choice", chosen());
  await loadFolder();
  await changed();
}

/** @type {{name: string, role: string, pieces: string[]}[]} records that are replaced by pieces, latest last */
const cut = [];

/** The latest record that was cut on this page, while its pieces are in use. */
export const latestCut = () => cut.at(-1);

/** Restores that record in place of its pieces. */
export function takeBack() {
  const { name, role, pieces } = /** @type {any} */ (cut.pop());
  return giveRoles({ ...Object.fromEntries(pieces.map((piece) => [piece, "off"])), [name]: role });
}

/** Swaps training and validation records. */
function swapRoles() {
  const other = { train: "judge", judge: "train", off: "off" };
  for (const name of Object.keys(choice.roles)) choice.roles[name] = other[choice.roles[name]];
  return changed();
}

/** Gives the role of a record to its pieces.
 * @param {string} name
 * @param {string[]} pieces
 */
export function replaceRecord(name, pieces) {
  cut.push({ name, role: choice.roles[name], pieces });
  return giveRoles({ ...Object.fromEntries(pieces.map((piece) => [piece, choice.roles[name]])), [name]: "off" });
}

/** Whether the name of a record says that it is for validation.
 * @param {string} name
 */
export const isForJudging = (name) => /valid|judge|held|test|check/i.test(name);

const chosen = () => ({ model: choice.model || "", beside: choice.beside, roles: choice.roles });

async function take(files) {
  const taken = [];
  for (const file of files) {
    try {
      const { name } = await upload(file);
      taken.push(name);
      notice(name + " is in the folder.");
    } catch (error) {
      notice(file.name + ": " + error.message);
    }
  }
  await loadFolder();
  await changed();
  const logs = namesOf("log").filter((name) => taken.includes(name));
  if (logs.length) location.hash = openAddress(logs);
}

function modelRow(name) {
  const beside = el("input", {
    type: "checkbox", checked: choice.beside.includes(name), disabled: name === choice.model,
    "aria-label": "Draw " + name + " beside it",
    onchange: (event) => {
      choice.beside = event.target.checked ? [...choice.beside, name] : choice.beside.filter((other) => other !== name);
      changed();
    },
  });
  const chosen = el("input", { type: "radio", name: "model", checked: name === choice.model, onchange: () => workOn(name) });
  return el("li", {}, el("label", { className: "name" }, chosen, el("span", {}, name)), el("label", { className: "beside", title: "Plot it beside the selected model" }, beside, "beside"));
}

const kRoles = [["train", "train"], ["judge", "held back"], ["off", "leave out"]];

/** @param {string} name */
export const recordAddress = (name) => "#record/" + encodeURIComponent(name);

function recordRow(name) {
  const select = el("select", {
    "aria-label": "Role of " + name,
    onchange: (event) => {
      choice.roles[name] = event.target.value;
      changed();
    },
  }, ...kRoles.map(([value, text]) => el("option", { value, selected: choice.roles[name] === value }, text)));
  return el("li", { className: "role-" + choice.roles[name] }, el("a", { className: "name", href: recordAddress(name), title: "Show its channels" }, name), select);
}

/** @param {string} name of a data sheet */
const identify = (name) => begin({ do: "identify", model: name, train: recordsAs("train"), accept: choice.accepted });

function sheetRow(name) {
  return el("li", {}, el("span", { className: "name" }, name), el("button", { type: "button", className: "small", disabled: !recordsAs("train").length, title: "Inertia and friction from the training records", onclick: () => identify(name) }, "Identify"));
}

/** What is missing until a model can be compared, and the button of the next step. */
export function firstSteps() {
  const sheet = namesOf("sheet")[0], hasRecords = recordsAs("train").length > 0;
  if (sheet && hasRecords) return el("p", {}, el("button", { type: "button", className: "primary", id: "identify", onclick: () => identify(sheet) }, "Identify a model of " + sheet), " Inertia and friction from the training records.");
  const needs = namesOf("sheet").length ? "training records" : hasRecords ? "the drive's data sheet" : "training records and the drive's data sheet";
  return el("p", { className: "lead" }, "A comparison needs a model. Drop one (.toml), or drop " + needs + ": a model is identified from them. The command axistool sheet makes a data sheet to fill in.");
}

/** Logs of one controller are opened together, because one log helps to recognise the channels of another.
 * @param {string[]} names
 */
const openAddress = (names) => "#open/" + names.map(encodeURIComponent).join("/");

function logRow(name) {
  return el("li", {}, el("span", { className: "name" }, name), el("a", { href: openAddress([name]), className: "button small" }, "Open"));
}

function group(title, tool, rows, empty) {
  return el("section", {}, el("div", { className: "row" }, el("h2", {}, title), tool), rows.length ? el("ul", {}, ...rows) : el("p", { className: "soft" }, empty));
}

function render() {
  document.getElementById("folder").textContent = choice.folder;
  const place = document.getElementById("choice");
  const focused = document.activeElement && place.contains(document.activeElement) ? document.activeElement.getAttribute("aria-label") : null;
  const input = el("input", { type: "file", multiple: true, id: "add-files", className: "hidden", onchange: (event) => take(event.target.files) });
  const drop = el("div", { className: "drop" }, el("button", { type: "button", onclick: () => input.click() }, "Add files…"), el("span", { className: "soft" }, "or drop them anywhere"), input);
  const swap = recordsAs("train").length && recordsAs("judge").length ? el("button", { type: "button", className: "small", id: "swap", title: "Exchange training and validation records", onclick: swapRoles }, "Swap roles") : null;
  const logs = namesOf("log"), sheets = namesOf("sheet");
  place.replaceChildren(
    drop,
    group("Models", null, namesOf("model").map(modelRow), "None yet: drop one (.toml), or identify one from records and a data sheet."),
    group("Records", swap, namesOf("record").map(recordRow), "None yet: drop some, or any controller's logs."),
    ...(sheets.length ? [group("Data sheets", null, sheets.map(sheetRow), "")] : []),
    ...(logs.length ? [group("Other logs", null, [...logs.map(logRow), ...(logs.length > 1 ? [el("li", {}, el("span", { className: "name soft" }, "of one controller"), el("a", { href: openAddress(logs), className: "button small" }, "Open all"))] : [])], "")] : [])
  );
  if (focused) /** @type {HTMLElement|null} */ (place.querySelector('[aria-label="' + CSS.escape(focused) + '"]'))?.focus();
}

export function acceptDrops() {
  const hold = (event) => {
    if (![...event.dataTransfer.types].includes("Files")) return;
    event.preventDefault();
    document.body.classList.toggle("dropping", event.type === "dragover");
    if (event.type === "drop") take(event.dataTransfer.files);
  };
  for (const type of ["dragover", "dragleave", "drop"]) document.addEventListener(type, hold);
}
