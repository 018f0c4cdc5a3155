// A canvas of its own for a stream: every channel in a lane, as the envelope of buckets. dygraphs would copy all points
// for every new one; here memory does not grow.

const kLane = 84, kFoot = 26, kLeft = 74;
/** Width of a bucket from which a line joins its middle to the next. */
const kWidePixels = 3;

const short = (value) => (isFinite(value) ? String(Number(value.toPrecision(4))) : "–");

/** A step of 1, 2 or 5 times a power of ten, near `rough`. */
function niceStep(rough) {
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * ([1, 2, 5].find((factor) => factor * power >= rough) || 10);
}

export class Scope {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {{names: string[], units: string[], period_s: number, start_s?: number}} stream `start_s`: time of row 0
   */
  constructor(canvas, stream) {
    this.canvas = canvas;
    this.stream = stream;
    /** @type {{a: number|null, b: number|null}} cursors, in rows */
    this.cursors = { a: null, b: null };
    /** @type {[number, number]|null} rows that are being selected */
    this.selection = null;
    this.isDue = false;
    /** Number of rows, if it is known: the last bucket may have fewer than the others. */
    this.end = Infinity;
    /** Whether rows are missing only because they have not been read yet. */
    this.isPartial = false;
    /** Rows that came, that are missing, and buckets that came twice. */
    this.counts = { taken: 0, missing: 0, twice: 0 };
    this.begin(1, 1);
  }

  /** Empties it for `buckets` buckets of `rows` rows.
   * @param {number} rows
   * @param {number} buckets
   */
  begin(rows, buckets) {
    this.rows = rows;
    this.room = buckets;
    this.next = -1; // number of the next bucket
    this.from = this.to = 0; // rows that are shown
    this.number = new Float64Array(buckets).fill(-1);
    this.taken = new Uint32Array(buckets);
    this.low = this.stream.names.map(() => new Float64Array(buckets));
    this.high = this.stream.names.map(() => new Float64Array(buckets));
    this.due();
  }

  /** Adds buckets; the newest ones move the view.
   * @param {{first: number, rows: number, taken: number[], low: (number|null)[][], high?: (number|null)[][]}} told
   */
  add(told) {
    const first = told.first / told.rows, high = told.high || told.low;
    if (this.next >= 0 && first > this.next) this.counts.missing += (first - this.next) * this.rows;
    for (let k = 0; k < told.taken.length; k++) {
      const number = first + k, place = number % this.room;
      if (number < this.next) {
        this.counts.twice++;
        continue;
      }
      this.counts.taken += told.taken[k];
      this.counts.missing += told.rows - told.taken[k];
      this.number[place] = number;
      this.taken[place] = told.taken[k];
      for (let channel = 0; channel < told.low.length; channel++) {
        this.low[channel][place] = told.low[channel][k] ?? NaN;
        this.high[channel][place] = high[channel][k] ?? NaN;
      }
      this.next = number + 1;
    }
    this.to = this.next * this.rows;
    this.from = this.to - this.room * this.rows;
    this.due();
  }

  /** The value range of a channel in a row's bucket, or null.
   * @param {number} channel
   * @param {number} row
   */
  at(channel, row) {
    const number = Math.floor(row / this.rows), place = number % this.room;
    return number >= 0 && this.number[place] === number && this.taken[place] ? [this.low[channel][place], this.high[channel][place]] : null;
  }

  /** The row below a point of the window.
   * @param {number} clientX
   */
  rowAt(clientX) {
    const box = this.canvas.getBoundingClientRect();
    const share = Math.min(1, Math.max(0, (clientX - box.left - kLeft) / Math.max(1, box.width - kLeft)));
    return Math.round(this.from + share * (this.to - this.from));
  }

  due() {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      if (this.canvas.isConnected) this.draw();
    });
  }

  /** Draws narrow buckets as upright bars on whole pixels, each joined to the one before it. A stroke would take the
   * browser ten times as long.
   * @param {CanvasRenderingContext2D} context
   * @param {number} channel
   * @param {number} first bucket
   * @param {number} last bucket
   * @param {(row: number) => number} x
   * @param {(value: number) => number} y
   */
  fillBars(context, channel, first, last, x, y) {
    const low = this.low[channel], high = this.high[channel];
    let before = -1;
    for (let number = first; number < last; number++) {
      const place = number % this.room;
      if (this.number[place] !== number || !this.taken[place] || isNaN(low[place])) {
        before = -1;
        continue;
      }
      const top = Math.round(y(before < 0 ? high[place] : Math.max(high[place], low[before])));
      const bottom = Math.round(y(before < 0 ? low[place] : Math.min(low[place], high[before])));
      const left = Math.round(x(number * this.rows));
      context.fillRect(left, top, Math.max(1, Math.round(x((number + 1) * this.rows)) - left), bottom - top + 1);
      before = place;
    }
  }

  draw() {
    const canvas = this.canvas, scale = devicePixelRatio || 1, lanes = this.stream.names.length;
    const width = canvas.clientWidth, height = lanes * kLane + kFoot;
    if (canvas.style.height !== height + "px") canvas.style.height = height + "px";
    if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
      canvas.width = Math.round(width * scale);
      canvas.height = Math.round(height * scale);
    }
    const style = getComputedStyle(document.documentElement), colour = (name) => style.getPropertyValue(name).trim();
    const context = canvas.getContext("2d");
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = "12px system-ui, sans-serif";
    context.textBaseline = "alphabetic";
    const x = (row) => kLeft + ((row - this.from) / Math.max(1, this.to - this.from)) * (width - kLeft);
    const first = Math.max(0, Math.floor(this.from / this.rows)), last = Math.ceil(this.to / this.rows);

    context.fillStyle = colour("--shade");
    for (let number = first; number < last; number++) {
      const place = number % this.room;
      const isLost = !this.isPartial && this.number[place] === number && this.taken[place] < Math.min(this.rows, this.end - number * this.rows);
      if (isLost) context.fillRect(x(number * this.rows), 0, Math.max(2, x((number + 1) * this.rows) - x(number * this.rows)), lanes * kLane);
    }
    if (this.selection) context.fillRect(x(Math.min(...this.selection)), 0, Math.abs(x(this.selection[1]) - x(this.selection[0])), lanes * kLane);

    for (let channel = 0; channel < lanes; channel++) {
      const top = channel * kLane + 18, bottom = (channel + 1) * kLane - 6;
      const low = this.low[channel], high = this.high[channel];
      let least = Infinity, most = -Infinity;
      for (let number = first; number < last; number++) {
        const place = number % this.room;
        if (this.number[place] !== number || !this.taken[place]) continue;
        if (low[place] < least) least = low[place];
        if (high[place] > most) most = high[place];
      }
      context.fillStyle = colour("--grid");
      context.fillRect(0, (channel + 1) * kLane - 1, width, 1);
      context.fillStyle = colour("--ink");
      context.textAlign = "left";
      context.fillText(this.stream.names[channel] + (this.stream.units[channel] ? " [" + this.stream.units[channel] + "]" : ""), kLeft + 4, channel * kLane + 13);
      if (!(least <= most)) continue;
      context.fillStyle = colour("--soft");
      context.textAlign = "right";
      context.fillText(short(most), kLeft - 6, top + 4);
      context.fillText(short(least), kLeft - 6, bottom + 4);
      const range = most - least || 1, y = (value) => bottom - ((value - least) / range) * (bottom - top);
      if (x(this.rows) - x(0) < kWidePixels) {
        context.fillStyle = colour("--model");
        this.fillBars(context, channel, first, last, x, y);
        continue;
      }
      context.strokeStyle = colour("--model");
      context.lineWidth = 1.2;
      context.beginPath();
      let isDown = false;
      for (let number = first; number < last; number++) {
        const place = number % this.room;
        if (this.number[place] !== number || !this.taken[place] || isNaN(low[place])) {
          isDown = false;
          continue;
        }
        const at = x((number + 0.5) * this.rows);
        isDown ? context.lineTo(at, y(low[place])) : context.moveTo(at, y(low[place]));
        if (high[place] !== low[place]) context.lineTo(at, y(high[place]));
        isDown = true;
      }
      context.stroke();
    }

    context.fillStyle = colour("--soft");
    context.textAlign = "center";
    const period = this.stream.period_s, start_s = this.stream.start_s || 0, from_s = start_s + this.from * period, to_s = start_s + this.to * period;
    const step = niceStep(Math.max(1e-6, to_s - from_s) / Math.max(2, (width - kLeft) / 110));
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    for (let k = Math.ceil(Math.max(start_s, from_s) / step); k * step <= to_s; k++)
      context.fillText((k * step).toFixed(digits) + " s", Math.min(width - 24, Math.max(kLeft + 20, x((k * step - start_s) / period))), height - 8);
    for (const [name, row] of Object.entries(this.cursors)) {
      if (row === null || row < this.from || row > this.to) continue;
      context.fillStyle = colour(name === "a" ? "--attention" : "--residual");
      context.fillRect(Math.round(x(row)), 0, 1.5, lanes * kLane);
      context.fillText(name.toUpperCase(), x(row), height - 8);
    }
  }
}
