// All channels of a record, however long: the program sends envelopes of the visible rows only.
import { choice, giveRoles, recordsAs } from "./choice.js";
import { commandLine, el, errorBox, notice, percent, short } from "./elements.js";
import { post } from "./exchange.js";
import { Scope } from "./scope.js";

const kAgain_ms = 120, kMostPictures = 24, kFewestRows = 8;

/** A picture of a record that zooms. While it waits for finer buckets, it shows the coarser ones. */
class Zoom {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {string} record
   * @param {(told: any) => void} onAnswer
   */
  constructor(canvas, record, onAnswer) {
    this.canvas = canvas;
    this.record = record;
    this.onAnswer = onAnswer;
    /** @type {any[]} answers, latest first */
    this.pictures = [];
    this.shown = null;
    this.end = 0; // rows of the record
    this.from = this.to = 0; // rows that are shown
    this.isAsking = false;
    /** @type {Scope|null} */
    this.scope = null;
    /** @type {string[]} */
    this.channels = [];
  }

  width() {
    return Math.max(200, this.canvas.clientWidth);
  }

  /** Shows these channels.
   * @param {string[]} channels
   */
  async choose(channels) {
    this.channels = channels;
    this.pictures = [];
    this.shown = this.scope = null;
    await this.ask();
  }

  /** The rows [from, to), moved and limited to the record.
   * @param {number} from
   * @param {number} to
   */
  look(from, to) {
    const span = Math.min(this.end, Math.max(kFewestRows, to - from)), begin = Math.min(Math.max(0, (from + to - span) / 2), this.end - span);
    this.from = begin;
    this.to = begin + span;
    this.draw();
    if (!this.isFine()) this.ask().catch((error) => notice(error.message));
  }

  /** @param {number} factor below 1: closer
   * @param {number} [row] that keeps its place */
  zoom(factor, row = (this.from + this.to) / 2) {
    this.look(row - (row - this.from) * factor, row + (this.to - row) * factor);
  }

  /** @param {number} share of what is shown */
  pan(share) {
    const by = share * (this.to - this.from);
    this.look(this.from + by, this.to + by);
  }

  /** The finest picture that covers what is shown, otherwise the one of the whole record. */
  best() {
    const covers = (told) => told.first <= this.from && told.first + told.taken.length * told.rows >= Math.min(this.to, this.end);
    return this.pictures.filter(covers).sort((a, b) => a.rows - b.rows)[0] || this.shown;
  }

  /** Whether the buckets are as small as those that the program would send. It rounds the range to whole rows. */
  isFine() {
    const best = this.best();
    return best && best.share === 1 && (best.rows === 1 || best.rows * this.width() < 2 * (this.to - this.from + 2));
  }

  draw() {
    const best = this.best();
    if (!this.scope || !best) return;
    if (best !== this.shown) {
      this.scope.begin(best.rows, best.taken.length);
      this.scope.add(best);
      this.shown = best;
    }
    this.scope.isPartial = best.share < 1;
    this.scope.from = this.from;
    this.scope.to = this.to;
    this.scope.due();
  }

  /** Asks for what is shown and half of it on both sides. One request at a time; the latest wish follows. */
  async ask() {
    if (this.isAsking) return;
    this.isAsking = true;
    try {
      const half = (this.to - this.from) / 2, asked = [this.from, this.to];
      const from = Math.max(0, Math.floor(this.from - half)), to = this.end ? Math.min(this.end, Math.ceil(this.to + half)) : Number.MAX_SAFE_INTEGER;
      const told = await post("/api/record", { record: this.record, channels: this.channels, from, to, pixels: Math.min(4000, 2 * this.width()) });
      if (!this.canvas.isConnected) return;
      this.take(told);
      const isMoved = asked[0] !== this.from || asked[1] !== this.to;
      if (told.share < 1 || (isMoved && !this.isFine())) setTimeout(() => this.canvas.isConnected && this.ask().catch((error) => notice(error.message)), told.share < 1 ? kAgain_ms : 0);
    } finally {
      this.isAsking = false;
    }
  }

  take(told) {
    if (!this.scope || this.end !== told.end) {
      this.scope = new Scope(this.canvas, { names: told.channels, units: told.channels.map(() => ""), period_s: told.period_s, start_s: told.start_s });
      this.scope.end = told.end;
      if (this.end !== told.end) Object.assign(this, { end: told.end, from: 0, to: told.end, pictures: [] });
    }
    // Pictures of a file that is still being read are incomplete.
    this.pictures = [told, ...this.pictures.filter((one) => one.share === 1)];
    if (this.pictures.length > kMostPictures) this.pictures.splice(1 + this.pictures.slice(1).reduce((least, one, k, all) => (one.rows < all[least].rows ? k : least), 0), 1);
    this.draw();
    this.onAnswer(told);
  }
}

/** Wheel: zoom at the pointer. Drag: zoom; with Shift: pan. Double click: all. Keys: + - and arrows.
 * @param {HTMLCanvasElement} canvas
 * @param {Zoom} zoom
 * @param {(row: number) => void} onPointer
 */
function pointers(canvas, zoom, onPointer) {
  let from = null, last = 0;
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    if (zoom.scope) zoom.zoom(1.0015 ** event.deltaY, zoom.scope.rowAt(event.clientX));
  }, { passive: false });
  canvas.addEventListener("pointerdown", (event) => {
    if (!zoom.scope) return;
    from = zoom.scope.rowAt(event.clientX);
    last = event.clientX;
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!zoom.scope) return;
    onPointer(zoom.scope.rowAt(event.clientX));
    if (from === null) return;
    if (event.shiftKey) {
      zoom.pan((last - event.clientX) / zoom.width());
      last = event.clientX;
    } else {
      zoom.scope.selection = [from, zoom.scope.rowAt(event.clientX)];
      zoom.scope.due();
    }
  });
  canvas.addEventListener("pointerup", () => {
    const selected = zoom.scope?.selection;
    from = null;
    if (!selected) return;
    zoom.scope.selection = null;
    const [begin, end] = [Math.min(...selected), Math.max(...selected)];
    end - begin > 0.005 * (zoom.to - zoom.from) ? zoom.look(begin, end) : zoom.draw();
  });
  canvas.addEventListener("dblclick", () => zoom.look(0, zoom.end));
  canvas.addEventListener("keydown", (event) => {
    const does = { "+": () => zoom.zoom(0.5), "-": () => zoom.zoom(2), ArrowLeft: () => zoom.pan(-0.2), ArrowRight: () => zoom.pan(0.2), Home: () => zoom.look(0, zoom.end) }[event.key];
    if (!does) return;
    event.preventDefault();
    does();
  });
}

/** The time of a row, to its sample period. */
function timeOf(told, row) {
  const digits = Math.min(9, Math.max(0, Math.ceil(-Math.log10(told.period_s))));
  return (told.start_s + row * told.period_s).toFixed(digits);
}

function statusText(told) {
  const faulty = told.faulty_rows + told.faulty_fields;
  return told.end.toLocaleString("en") + " rows, " + short((told.end - 1) * told.period_s) + " s" + (told.share < 1 ? " · " + percent(told.share) + " read" : "") +
    (faulty ? " · not drawn: " + told.faulty_rows + " rows without a time that fits, and " + told.faulty_fields + " fields that are not numbers" : "");
}

/** Draws a record into a place, and tools that zoom and cut.
 * @param {Element} place
 * @param {string} record
 */
export async function showPicture(place, record) {
  const canvas = el("canvas", { className: "scope", tabIndex: 0, role: "img", "aria-label": "Channels of " + record + " over time. Plus and minus zoom, arrows move, Home shows all." });
  const status = el("p", { className: "soft", id: "record-status", role: "status" }, "Reading…"), reading = el("p", { className: "soft", id: "record-reading" }, " "), cut = el("div"), columns = el("div", { className: "row" });
  let latest = null;
  const zoom = new Zoom(canvas, record, (told) => {
    status.textContent = statusText(told);
    if (latest === null) drawChannels(told);
    latest = told;
  });

  function drawChannels(told) {
    if (told.columns.length < 2) return;
    const chosen = new Set(told.channels);
    const change = (event) => {
      event.target.checked ? chosen.add(event.target.value) : chosen.delete(event.target.value);
      zoom.choose(told.columns.filter((name) => chosen.has(name))).catch((error) => notice(error.message));
    };
    columns.replaceChildren(...told.columns.map((name) => el("label", {}, el("input", { type: "checkbox", value: name, checked: chosen.has(name), onchange: change }), " " + name)));
  }

  async function keep() {
    try {
      const stretch = [zoom.from, zoom.to].map((row) => Number(timeOf(latest, Math.round(row))));
      const told = await post("/api/cut", { record, stretch, keep: true });
      const open = () => giveRoles({ ...Object.fromEntries([...recordsAs("train"), ...recordsAs("judge")].map((name) => [name, "off"])), [told.pieces[0]]: "train" }).then(() => (location.hash = "#compare"));
      cut.replaceChildren(commandLine(told.commands[0]), el("button", { type: "button", className: "primary", id: "open-cut", onclick: open }, "Compare " + told.pieces[0] + " instead"));
    } catch (error) {
      notice(error.message);
    }
  }

  const tool = (id, text, onclick) => el("button", { type: "button", id, onclick }, text);
  place.replaceChildren(status,
    el("div", { className: "row" }, tool("zoom-in", "Closer", () => zoom.zoom(0.5)), tool("zoom-out", "Further", () => zoom.zoom(2)), tool("zoom-all", "Whole record", () => zoom.look(0, zoom.end)), tool("keep-shown", "Keep what is shown as a record", keep)),
    el("figure", { className: "scope-frame" }, canvas, el("p", { className: "soft" }, "Wheel or drag: zoom. Drag with Shift: move. Double click: all. Shaded: missing rows. Each column of the picture shows the smallest and the largest value.")),
    reading, columns, cut);
  pointers(canvas, zoom, (row) => {
    const values = zoom.scope.stream.names.map((name, channel) => ({ name, range: zoom.scope.at(channel, row) }));
    reading.textContent = timeOf(latest, row) + " s: " + values.map(({ name, range }) => name + " " + (range ? [...new Set(range.map(short))].join(" to ") : "–")).join(", ");
  });
  const redraw = () => (canvas.isConnected ? zoom.look(zoom.from, zoom.to) : window.removeEventListener("resize", redraw));
  window.addEventListener("resize", redraw);
  canvas.zoom = zoom; // for tests
  try {
    await zoom.ask();
  } catch (error) {
    place.replaceChildren(errorBox(error));
  }
}

/** @param {Element} place
 * @param {string|undefined} record */
export async function showRecord(place, record) {
  const name = record || recordsAs("train")[0] || choice.files.find((file) => file.kind === "record")?.name;
  const box = el("div");
  place.replaceChildren(el("div", { className: "row head" }, el("h1", {}, "Record"), el("span", { className: "soft" }, name || "")), box);
  if (name) await showPicture(box, name);
}
