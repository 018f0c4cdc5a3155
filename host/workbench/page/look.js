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
  if (!looks.has(key)) looks.set(key, post("/api/look", request).then((told) => (told.document ? told : null)).catch(() => null));
  return /** @type {Promise<any>} */ (looks.get(key));
}

/** The answers of a diagnosis, most probable first; `kinds` is empty for "something else" and "nothing is missing".
 * @param {any} told axis-diagnosis/1
 * @returns {{kinds: string[], title: string, probability: number}[]}
 */
export function ranked(told) {
  const { probability_other: other, probability_nothing: nothing } = told.verdict;
  const answers = [...told.candidates.map(({ kinds, probability }) => ({ kinds, title: "", probability })),
    { kinds: [], title: "Something else", probability: other }, { kinds: [], title: "Nothing is missing", probability: nothing }];
  return answers.filter((one) => one.probability > 0).sort((a, b) => b.probability - a.probability);
}
