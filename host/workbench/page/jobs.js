// Starts, shows and cancels long jobs of the program. Their state is in the folder.
import { commandLine, el, notice, percent } from "./elements.js";
import { fileAddress, get, post, report } from "./exchange.js";

/** @type {any[]} latest first */
export let jobs = [];
const listeners = new Set();
export const isOpen = (job) => job.state === "queued" || job.state === "running";
/** @type {Set<number>|undefined} jobs that had ended at the last poll, because a short job may never be seen running */
let endedBefore;
let timer = 0;
/** Until then the page looks often, because a short job may end at once. */
let hastyUntil = 0;

/** Registers a listener that receives the jobs that have ended since the last poll; returns a function that ends this.
 * @param {(ended: any[]) => void} listener
 */
export function onJobs(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

export async function lookAtJobs() {
  clearTimeout(timer);
  try {
    jobs = (await get("/api/jobs")).jobs;
  } catch (error) {
    notice(error.message);
    timer = setTimeout(lookAtJobs, 5000);
    return;
  }
  const known = endedBefore ?? new Set(jobs.map((job) => job.id));
  const ended = jobs.filter((job) => !isOpen(job) && !known.has(job.id));
  endedBefore = new Set(jobs.filter((job) => !isOpen(job)).map((job) => job.id));
  listeners.forEach((listener) => listener(ended));
  if (jobs.some(isOpen)) timer = setTimeout(lookAtJobs, performance.now() < hastyUntil ? 40 : 150);
}

/** @param {any} request */
export async function begin(request) {
  hastyUntil = performance.now() + 3000;
  try {
    await post("/api/jobs", request);
  } catch (error) {
    notice(error.message);
  }
  await lookAtJobs();
}

/** @param {any} job */
export async function cancel(job) {
  await post("/api/jobs/" + job.id + "/cancel", {}).catch((error) => notice(error.message));
  await lookAtJobs();
}

/** A job with its document.
 * @param {any} job
 */
export function whole(job) {
  return get("/api/jobs/" + job.id);
}

/** The fields of a request in one order.
 * @param {any} request
 */
const inOrder = (request) => JSON.stringify(Object.entries(JSON.parse(JSON.stringify(request))).sort());

/** Comparisons that this tab has begun, also before a reload: it waits for and cancels no others. */
const kBegun = "comparisons";
const isBegunHere = (job) => (sessionStorage.getItem(kBegun) || "").split(" ").includes(String(job.id));

/** The result of a long comparison, like that of /api/compare: of an earlier job, or of one that is begun. One that
 * this tab waited for until now is cancelled.
 * @param {any} request
 */
export async function compared(request) {
  const words = inOrder(request), isThis = (job) => job.request.do === "compare" && inOrder(job.request) === words;
  for (const job of jobs) if (isOpen(job) && job.request.do === "compare" && isBegunHere(job) && !isThis(job)) await cancel(job);
  let id = jobs.find((job) => isThis(job) && (job.state === "done" || (isOpen(job) && isBegunHere(job))))?.id;
  if (!id) {
    id = (await post("/api/jobs", request)).id;
    sessionStorage.setItem(kBegun, (sessionStorage.getItem(kBegun) || "") + " " + id);
    await lookAtJobs();
  }
  const found = () => jobs.find((job) => job.id === id);
  if (isOpen(found()))
    await new Promise((resolve) => {
      const leave = onJobs(() => isOpen(found()) || (leave(), resolve(null)));
    });
  const job = await whole(found());
  if (job.state === "cancelled") throw new Error("cancelled");
  if (job.state !== "done") throw Object.assign(new Error(job.message || job.state), { log: job.log });
  return { ...job, report: job.report ? await report(job.report) : "" };
}

const kVerbs = { compare: "Comparing", identify: "Identifying", diagnose: "Searching for the missing effect", add: "Fitting", adjust: "Setting values", improve: "Adding significant effects", commission: "Commissioning" };

/** @param {any} job */
export function titleOf(job) {
  if (job.request.do === "commission") return kVerbs.commission + " axis " + job.request.axis + ": " + job.request.folder;
  const kind = job.request.kind ? " " + job.request.kind.replaceAll("_", " ").replaceAll("+", " + ") : "";
  return (kVerbs[job.request.do] || job.request.do) + kind + ": " + (job.request.model || job.request.models.join(", "));
}

/** @param {any} job */
function progressBar(job) {
  return el("div", { className: "progress", id: "progress-" + job.id }, el("span"), el("progress", { max: 1, "aria-label": titleOf(job) }),
    el("button", { type: "button", onclick: () => cancel(job) }, "Cancel"));
}

/** A progress bar for each running job. Bars stay the same elements: a button that is replaced while it is pressed is
 * never clicked.
 * @param {Element} place
 */
export function showProgress(place) {
  const running = jobs.filter(isOpen).reverse();
  for (const bar of [...place.children]) if (!running.some((job) => bar.id === "progress-" + job.id)) bar.remove();
  for (const job of running) {
    let bar = place.querySelector("#progress-" + job.id);
    if (!bar) place.append((bar = progressBar(job)));
    const known = job.state === "running" && job.share > 0, share = bar.querySelector("progress");
    bar.querySelector("span").textContent = titleOf(job) + (job.state === "queued" ? " (waits)" : known ? " · " + percent(job.share) : "") + (job.message ? " · " + job.message : "");
    if (known) share.value = job.share;
    else share.removeAttribute("value");
  }
}

/** @param {Element} place */
export function showJobs(place) {
  const rows = jobs.map((job) => el("li", { className: "job " + job.state },
    el("div", { className: "row" }, el("span", { className: "badge" }, job.state), el("strong", {}, titleOf(job)),
      el("span", { className: "soft" }, new Date(1000 * (job.asked_s || 0)).toLocaleString())),
    job.message ? el("p", {}, job.message) : null,
    commandLine(job.command),
    el("div", { className: "row" },
      job.state === "done" && job.report ? el("a", { href: fileAddress(job.report), target: "_blank", rel: "noopener" }, "Whole report") : null,
      isOpen(job) ? el("button", { type: "button", onclick: () => cancel(job) }, "Cancel") : job.request.do === "commission" ? el("a", { href: "#live" }, "Continue in Live") : el("button", { type: "button", onclick: () => begin(job.request) }, "Run again"))));
  place.replaceChildren(el("h1", {}, "Jobs"),
    el("p", { className: "lead" }, "Jobs, latest first. Results are in the subfolder “workbench”; new models are beside their original."),
    rows.length ? el("ol", { className: "jobs" }, ...rows) : el("p", { className: "soft" }, "None yet."));
}
