// The answer sheet: each cell is saved as it is typed, sent again until the server has it, and checked on request.

import { Outbox, Unanswered } from "./outbox.js";
import { clock, element, errors, fill, moment, newId, send, words } from "./requests.js";

const TYPING = 500, FIRST_WAIT = 1000, LONGEST_WAIT = 30000, BATCH = 100;
const sheet = document.getElementById("answers"), saving = document.getElementById("saving");
const inputs = [...sheet.querySelectorAll("input[data-id]")];
const closed = "closed" in sheet.dataset;
const variant = sheet.dataset.variant;
// Cells of another variant are not sent for this one.
const name = `${sheet.dataset.owner}:${variant}`, outbox = new Outbox(name), unanswered = new Unanswered(name, newId);
const channel = "BroadcastChannel" in window ? new BroadcastChannel(`reportgen:${name}`) : undefined;
const timers = new Map();
const places = new Map(inputs.map((input) => [`${input.dataset.id}@${input.dataset.position}`, input]));
let revision = Number(sheet.dataset.revision) || 0, wait = FIRST_WAIT, retry, running, barred = "";

const find = ({ id, position }) => places.get(`${id}@${position}`);
const cellOf = (input) => ({ id: input.dataset.id, position: Number(input.dataset.position), text: input.value });

function mark(input, state, text) {
  if (!input) return;
  input.closest(".cell").dataset.state = state;
  document.getElementById(input.getAttribute("aria-describedby")).textContent = text ?? words[state] ?? "";
}

function summarise(state) {
  if (!saving) return;
  const count = outbox.all().length + timers.size;
  saving.dataset.state = barred ? "unsaved" : !count ? "saved" : state ?? "saving";
  const said = barred || (!count ? fill(words.all_saved, { time: clock() })
    : state === "unsaved" ? fill(words.unsaved_count, { count }) : words.saving);
  if (saving.textContent !== said) saving.textContent = said;
}

function count() {
  for (const shown of sheet.querySelectorAll("[data-filled]")) {
    const own = [...shown.closest(".sheet").querySelectorAll("input[data-id]")];
    shown.textContent = own.length ? `${own.filter((input) => input.value.trim()).length}/${own.length}` : "";
  }
}

// Put what was typed into the outbox, unless it is already there or the server has it.
function keep(input) {
  clearTimeout(timers.get(input));
  timers.delete(input);
  const cell = cellOf(input), standing = outbox.get(cell.id, cell.position);
  if (standing ? standing.text === cell.text : input.dataset.known === cell.text) mark(input, "saved");
  else outbox.put({ client: newId(), ...cell });
}

function typed({ target }) {
  if (closed || !target.dataset.id) return;
  clearTimeout(timers.get(target));
  mark(target, "saving");
  forget(target);
  timers.set(target, setTimeout(() => { keep(target); flush(); }, TYPING));
  summarise();
  count();
}

function settle() {
  for (const input of [...timers.keys()]) keep(input);
  return flush();
}

// One request at a time, so that an older value never arrives after a newer one.
async function flush() {
  while (running) await running;
  clearTimeout(retry);
  running = work();
  const done = await running;
  running = undefined;
  return done;
}

async function work() {
  while (outbox.all().length && !closed) {
    const cells = outbox.all().slice(0, BATCH);
    for (const cell of cells) mark(find(cell), "saving");
    summarise();
    try {
      received(cells, await send("/me/cells", { variant, cells }));
    } catch (error) {
      for (const cell of outbox.all()) mark(find(cell), "unsaved");
      barred = error.again ? "" : error.status === 401 || error.status === 403 ? words.expired : error.message;
      summarise("unsaved");
      retry = setTimeout(flush, wait);
      wait = Math.min(2 * wait, LONGEST_WAIT);
      return false;
    }
  }
  summarise();
  return true;
}

function received(cells, answer) {
  barred = "";
  const saved = new Set(answer.saved.map((one) => one.client));
  const refused = new Map((answer.refused ?? []).map((one) => [one.client, one.message ?? errors[one.error]]));
  for (const cell of cells) {
    if (!saved.has(cell.client) && !refused.has(cell.client)) continue;
    outbox.remove(cell);
    const input = find(cell);
    if (input && saved.has(cell.client)) input.dataset.known = cell.text;
    if (!outbox.get(cell.id, cell.position) && !timers.has(input)) {
      mark(input, refused.has(cell.client) ? "refused" : "saved", refused.get(cell.client));
    }
  }
  if (!saved.size && !refused.size) throw Object.assign(new Error(words.unreachable), { again: true });
  wait = FIRST_WAIT;
  channel?.postMessage(cells.filter((cell) => saved.has(cell.client)));
}

// Take over cells that another tab or device has saved, but nothing that is being typed here.
function show(cells) {
  for (const cell of cells) {
    const input = find(cell);
    if (!input || outbox.get(cell.id, cell.position) || timers.has(input)) continue;
    input.dataset.known = cell.text;
    if (input.value === cell.text) continue;
    input.value = cell.text;
    mark(input, "saved", "");
    forget(input);
  }
  count();
}

async function refresh() {
  try {
    const state = await send(`/me/state?since=${revision}`);
    show(state.cells);
    revision = state.revision;
  } catch {
    // The next save reports it.
  }
}

// --- checks ---------------------------------------------------------------------------------------

const VERDICTS = ["right", "wrong", "follows", "unread", "empty"];

function forget(input) {
  input.closest(".cell").classList.remove(...VERDICTS);
  input.removeAttribute("aria-invalid");
}

function judged(cells) {
  for (const cell of cells) {
    const input = find(cell);
    if (!input) continue;
    forget(input);
    input.closest(".cell").classList.add(cell.verdict);
    if (cell.verdict === "wrong" || cell.verdict === "unread") input.setAttribute("aria-invalid", "true");
    mark(input, "checked", cell.message || words.verdicts[cell.verdict]);
  }
}

// Check what a button stands for: its section, or the cell beside it, which has its outcome itself.
async function check(button, asked, outcome) {
  const left = document.getElementById("left");
  button.disabled = true;
  outcome.textContent = words.checking;
  const question = JSON.stringify(asked);
  try {
    if (!(await settle())) throw new Error(words.not_saved_first);
    const client = unanswered.ask(question, JSON.stringify(inputs.map((input) => input.value)));
    const answer = await send("/me/check", { client, ...asked }, 120000);
    unanswered.end(question);
    if (asked.section) outcome.replaceChildren(...(answer.lines ?? []).map((line) => element("p", line.trim())));
    judged(answer.cells ?? []);
    if (left && Number.isInteger(answer.checks_left)) left.textContent = fill(words.checks_left, { count: answer.checks_left });
  } catch (error) {
    if (error.status && !error.again) unanswered.end(question);
    outcome.textContent = error.message;
  }
  button.disabled = false;
}

// One button for all cells: it comes to the cell that has the focus.
const single = element("button", "✓?", { type: "button", className: "single", ariaLabel: words.check_cell, title: words.check_cell });

function offer({ target }) {
  if (!target.dataset?.id) return;
  target.after(single);
  single.hidden = !target.value.trim();
}

function checkCell() {
  const input = single.previousElementSibling, { id, position } = cellOf(input);
  check(single, { id, position }, document.getElementById(input.getAttribute("aria-describedby")));
}

// --- handing in -----------------------------------------------------------------------------------

const button = document.getElementById("hand-in"), handing = document.getElementById("handing");

async function handIn() {
  const empty = inputs.filter((input) => !input.value.trim()).length;
  // A second press confirms: nothing covers the page, and a screen reader announces the question.
  if (empty && !button.dataset.sure) {
    button.dataset.sure = "yes";
    handing.textContent = fill(words.still_empty, { count: empty });
    return;
  }
  button.disabled = true;
  try {
    if (!(await settle())) throw new Error(words.not_saved_first);
    const answer = await send("/me/hand-in", { client: newId() });
    document.getElementById("handed").textContent = fill(words.handed_in, { time: moment(answer.at) });
    handing.replaceChildren(
      fill(words.handed_in_count, { filled: answer.filled, asked: answer.asked }),
      element("span", ` SHA-256 ${answer.sha256}`, { className: "digest" }),
    );
  } catch (error) {
    handing.textContent = error.message;
  }
  button.disabled = false;
  delete button.dataset.sure;
}

// --- the page -------------------------------------------------------------------------------------

for (const input of inputs) {
  // A browser may have kept an older text in the field over a reload.
  input.value = input.dataset.known = input.defaultValue;
  const kept = outbox.get(input.dataset.id, input.dataset.position);
  if (!kept) continue;
  if (closed) {
    // The deadline came first: the student and the instructor can still see what was typed.
    mark(input, "refused", fill(words.too_late, { text: kept.text }));
  } else {
    input.value = kept.text;
    mark(input, "unsaved");
  }
}
sheet.addEventListener("input", typed);
sheet.addEventListener("change", ({ target }) => { if (timers.has(target)) { keep(target); flush(); } });
sheet.addEventListener("keydown", (event) => {
  const at = inputs.indexOf(event.target);
  if (event.key !== "Enter" || at < 0) return;
  event.preventDefault();
  inputs[at + (event.shiftKey ? -1 : 1)]?.focus();
});
sheet.addEventListener("click", ({ target }) => {
  if (target.matches("[data-check]")) check(target, { section: target.dataset.check }, target.parentElement.querySelector(".outcome"));
});
if (document.querySelector("[data-check]")) {
  single.addEventListener("click", checkCell);
  sheet.addEventListener("focusin", offer);
  sheet.addEventListener("input", offer);
}
button?.addEventListener("click", handIn);
channel?.addEventListener("message", ({ data }) => show(data));
addEventListener("online", () => { wait = FIRST_WAIT; flush(); });
addEventListener("focus", refresh);
addEventListener("pagehide", () => { for (const input of [...timers.keys()]) keep(input); });
document.addEventListener("visibilitychange", () => { if (document.hidden) settle(); else flush(); });
addEventListener("beforeunload", (event) => { settle(); if (outbox.all().length) event.preventDefault(); });
count();
summarise();
flush();
