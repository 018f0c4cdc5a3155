// The page: selects the view by its address, handles keys, and redraws after changes.
import { lookAtBoard, stream } from "./board.js";
import { acceptDrops, loadFolder, onChoice } from "./choice.js";
import { leaveCompare, showCompare } from "./compare.js";
import { stopButton } from "./command.js";
import { el, errorBox } from "./elements.js";
import { follow, keys, showEffects } from "./effects.js";
import { showGallery } from "./gallery.js";
import { leaveLoop, showLoop } from "./loop.js";
import { leaveLive, liveKey, showLive } from "./live.js";
import { showOpening } from "./opening.js";
import { showRecord } from "./record.js";
import { jobs, lookAtJobs, onJobs, showJobs, showProgress } from "./jobs.js";
import { forgetPlots } from "./report_parts.js";
import { continueTheOne, stopsPlace, watchStops } from "./stops.js";

/** @type {[string, string, (place: Element, detail?: string) => any][]} */
const kViews = [["compare", "Compare", showCompare], ["effects", "Effects", showEffects], ["gallery", "Gallery", showGallery], ["jobs", "Jobs", showJobs], ["live", "Live", showLive], ["loop", "Loop", showLoop]];
const content = el("div", { id: "content" }), progress = el("div", { id: "progress" });

const address = () => location.hash.slice(1).split("/").map(decodeURIComponent);
const isShown = (name) => (address()[0] || "compare") === name;

function links() {
  document.body.classList.toggle("live", isShown("live"));
  document.getElementById("views").replaceChildren(...kViews.map(([name, text], index) =>
    el("a", { href: "#" + name, title: "Key " + (index + 1), ...(isShown(name) ? { "aria-current": "page" } : {}) }, text)));
}

async function show() {
  const [name, ...details] = address();
  const view = kViews.find((one) => one[0] === name) || kViews[0];
  links();
  try {
    await (name === "open" ? showOpening(content, details) : name === "record" ? showRecord(content, details.join("/")) : view[2](content, details[0]));
  } catch (error) {
    forgetPlots();
    content.replaceChildren(errorBox(error));
  }
}

function goTo() {
  leaveLive();
  leaveCompare();
  leaveLoop();
  content.classList.remove("waiting");
  forgetPlots();
  content.replaceChildren();
  show();
  window.scrollTo(0, 0);
}

function pressed(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || event.target.closest("input:not([type=radio]):not([type=checkbox]), select, textarea")) return;
  if (event.key === "Enter" && !event.repeat && !event.target.closest("a, button, input, summary")) return continueTheOne();
  const view = kViews[Number(event.key) - 1];
  if (view && !isShown(view[0])) location.hash = view[0];
  else if (view) return;
  else if (isShown("effects")) keys[event.key]?.();
  else if (isShown("live")) liveKey(event.key);
}

/** What the list of jobs shows. */
const statesOfJobs = () => JSON.stringify(jobs.map((job) => [job.id, job.state, job.message]));
let shownStates = "";

async function start() {
  if (location.search) history.replaceState(null, "", "/" + location.hash); // the token is in the cookie now
  document.getElementById("view").replaceChildren(stopsPlace, progress, content);
  acceptDrops();
  onChoice(() => !["jobs", "open", "live", "record"].some(isShown) && show());
  onJobs(async (ended) => {
    showProgress(progress);
    const isNew = statesOfJobs() !== shownStates;
    shownStates = statesOfJobs();
    const isDrawn = await follow(ended);
    if ((isNew && isShown("jobs")) || (ended.length && !isDrawn && isShown("effects"))) show();
    if (ended.length) await loadFolder();
  });
  window.addEventListener("hashchange", goTo);
  document.addEventListener("keydown", pressed);
  watchStops();
  try {
    if ((await lookAtBoard()).device) {
      document.querySelector("header.bar").append(stopButton());
      stream(0, 0, () => {});
    }
    await loadFolder();
    await lookAtJobs();
    await show();
  } catch (error) {
    content.replaceChildren(errorBox(error));
  }
}

start();
