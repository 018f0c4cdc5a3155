// The catalogue of effects, fetched once.
import { get } from "./exchange.js";

let catalogue = null;

/**
 * All of axis-effects/1.
 * @returns {Promise<any[]>}
 */
export async function effects() {
  catalogue ??= (await get("/api/effects")).effects;
  return catalogue;
}
