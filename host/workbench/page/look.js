// The first look: result of the force-balance regression alone for the chosen records. It takes seconds.
import { choice, chosenRecords } from "./choice.js";
import { post } from "./exchange.js";

/** @type {Map<string, Promise<any>>} by request; files with the same name do not change */
const looks = new Map();

/**
 * { document, report, command } of `axistool diagnose --quick`; null if the records allow no force balance.
 * @returns {Promise<any>}
 */
export function firstLook() {
  const { train, validate } = chosenRecords();
  if (!choice.model || !train.length) return Promise.resolve(null);
  const request = { do: "diagnose", quick: true, model: choice.model, train, validate, accept: choice.accepted };
  const key = JSON.stringify(request);
  if (!looks.has(key)) looks.set(key, post("/api/look", request).catch(() => null));
  return /** @type {Promise<any>} */ (looks.get(key));
}

/** The most probable answer: { kinds, probability }; `kinds` is empty for "something else" and "nothing is missing".
 * @param {any} told axis-diagnosis/1
 */
export function mostProbable(told) {
  const best = told.candidates.reduce((one, other) => (other.probability > one.probability ? other : one), { kinds: [], probability: 0 });
  const { probability_other: other, probability_nothing: nothing } = told.verdict;
  if (other > best.probability && other > nothing) return { kinds: [], title: "Something else", probability: other };
  if (nothing > best.probability) return { kinds: [], title: "Nothing is missing", probability: nothing };
  return { kinds: best.kinds, title: "", probability: best.probability };
}
