// The board behind `axistool serve --device`: what it is, how it is, and its stream.
import { get } from "./exchange.js";

/** @type {{device: string|null, board?: string, epoch: number, period_s: number, axes: any[], channels: {name: string, unit: string}[], streamed: string[], most: number}} */
export let board = { device: null, epoch: 0, period_s: 0.001, axes: [], channels: [], streamed: [], most: 12 };
/** @type {any} the latest state that was told */
export let state = null;

const listeners = new Set();
/** @type {EventSource|null} */
let source = null;
/** @type {((rows: any) => void)|null} */
let takeRows = null;

/** Calls the listener after every state; returns a function that ends this.
 * @param {() => void} listener
 */
export function onBoard(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Asks what the board is. Call it again after a change of the stream. */
export async function lookAtBoard() {
  board = { ...board, ...(await get("/api/live")) };
  return board;
}

const told = (/** @type {any} */ next) => {
  state = next;
  listeners.forEach((listener) => listener());
};

/** Opens a stream, in place of an earlier one. EventSource itself continues it after an interruption.
 * @param {number} rows of a bucket; 0: states only
 * @param {number} back rows of the past, to begin with
 * @param {(rows: any) => void} take
 */
export function stream(rows, back, take) {
  closeStream();
  takeRows = take;
  source = new EventSource("/api/live/stream?rows=" + rows + "&back=" + back);
  source.addEventListener("rows", (event) => takeRows?.(JSON.parse(event.data)));
  source.addEventListener("state", (event) => told(JSON.parse(event.data)));
  source.addEventListener("error", () => told({ ...(state || { axes: [], epoch: 0 }), connected: false, owner: 0, message: "axistool serve does not answer: is it still running?" }));
}

export function closeStream() {
  source?.close();
  source = takeRows = null;
}
