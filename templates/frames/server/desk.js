// The instructor's desk: the class as a table that sorts, filters and renews itself, and what is done for all of it.

import { Refused, clock, data, element, fill, moment, number, send, words } from "./requests.js";

const EVERY = 15000, WHILE_MARKING = 1500;
const body = document.querySelector("#students tbody"), summary = document.getElementById("summary");
const search = document.getElementById("search"), which = document.getElementById("which");
const by = (id) => document.getElementById(id);
let table = data("table-data"), order = "", falling = false, timer;

const FILTERS = {
  all: () => true,
  unopened: (one) => !one.opened,
  open: (one) => !one.handed_in,
  handed: (one) => one.handed_in,
  unread: (one) => one.state === "refused" || one.state === "kept",
  warned: (one) => one.warnings.length,
};
const VALUES = {
  name: (one) => one.name || one.id,
  opened: (one) => (one.opened ? 1 : 0),
  saved: (one) => one.filled,
  handed_in: (one) => one.handed_in ?? "",
  state: (one) => one.state,
  mark: (one) => one.mark ?? -1,
  warnings: (one) => one.warnings.length,
};
const value = (one, key) => (VALUES[key] ?? ((it) => it[key] ?? ""))(one);
const compare = (a, b) => (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), "vi", { numeric: true }));
const folded = (text) => text.normalize("NFD").replace(/\p{M}/gu, "").replaceAll("đ", "d").toLowerCase();

const files = (one) => [one.state ? words.short_states[one.state] ?? one.state : one.uploads ? words.short_states.queued : one.earlier ? "" : "–"];
const CELLS = {
  id: (one) => [one.id],
  name: (one) => [element("a", one.name || one.id, { href: `/desk/students/${encodeURIComponent(one.folder)}` })],
  class: (one) => [one.class],
  opened: (one) => [one.opened ? words.opened : "–"],
  saved: (one) => [`${one.filled}/${one.asked}`],
  handed_in: (one) => [one.handed_in ? moment(one.handed_in) : "–", ...(one.changed ? [` ${words.changed}`] : [])],
  state: (one) => [...files(one), ...(one.earlier ? [element("span", fill(words.earlier_uploads, { count: one.earlier }), { className: "line" })] : [])],
  mark: (one) => [number(one.mark)],
  warnings: (one) => one.warnings.map((text) => element("span", text, { className: "warning" })),
};
const columns = [...document.querySelectorAll("[data-sort]")].map((button) => button.dataset.sort);

function rows() {
  const sought = folded(search.value.trim());
  const chosen = table.students.filter(FILTERS[which.value] ?? FILTERS.all)
    .filter((one) => !sought || folded(`${one.id} ${one.name} ${one.class}`).includes(sought));
  if (order) chosen.sort((a, b) => (falling ? -1 : 1) * compare(value(a, order), value(b, order)));
  return chosen;
}

function show() {
  body.replaceChildren(...rows().map((one) => element("tr", columns.map((key) => element(key === "name" ? "th" : "td", CELLS[key](one), key === "name" ? { scope: "row" } : { className: key })))));
  for (const button of document.querySelectorAll("[data-sort]")) {
    const head = button.closest("th");
    if (button.dataset.sort === order) head.setAttribute("aria-sort", falling ? "descending" : "ascending");
    else head.removeAttribute("aria-sort");
  }
  const all = table.students, some = (test) => all.filter(test).length;
  const said = [
    fill(words.summary, {
      count: all.length, opened: some((one) => one.opened), handed: some((one) => one.handed_in), marked: some((one) => one.mark !== null),
    }),
    table.closes ? fill(words.closes, { time: moment(table.closes) }) : words.closes_never,
    table.marking ? words.marking : table.marked_at ? fill(words.marked_at, { time: moment(table.marked_at) }) : words.not_marked,
    table.released ? words.released : words.not_released,
    ...(table.queue ? [fill(words.queue, { count: table.queue })] : []),
  ].join(" ");
  if (summary.textContent !== said) summary.textContent = said;
  doubt(table.clock);
  by("release").textContent = table.released ? words.withdraw : words.release;
  by("mark").disabled = table.marking;
  by("release").disabled = table.marking || (!table.released && !table.marked_at);
  by("problems").replaceChildren(...table.problems.map((text) => element("p", text, { className: "warning" })));
}

let doubted = "";

// Say that the clock may be wrong, with a button for when it is right.
function doubt(clock) {
  const said = clock ? fill(words.clock_doubt, { now: moment(clock.now), last: moment(clock.last) }) : "";
  if (said === doubted) return;
  doubted = said;
  const right = element("button", words.clock_right, { type: "button" });
  right.addEventListener("click", () => act("/desk/clock", {}));
  by("clock").replaceChildren(...(said ? [element("p", [said, " ", right], { className: "warning" })] : []));
}

async function renew() {
  clearTimeout(timer);
  try {
    const marking = table.marking;
    table = await send("/desk/table");
    show();
    if (marking && !table.marking) notices();
  } catch (error) {
    if (!error.again) by("acting").textContent = error.message;
  }
  timer = setTimeout(renew, table.marking || table.queue ? WHILE_MARKING : EVERY);
}

const student = (folder) => table.students.find((one) => one.folder === folder);
const named = (folder) => element("a", student(folder)?.name || folder, { href: `/desk/students/${encodeURIComponent(folder)}` });

async function notices() {
  try {
    const noticed = (await send("/desk/notices")).notices;
    by("notices").replaceChildren(...noticed.map(notice));
    if (!noticed.length) by("notices").replaceChildren(element("li", words.no_notices));
  } catch (error) {
    by("notices").replaceChildren(element("li", error.message));
  }
}

function notice({ kind, count, students }) {
  const made = element("li", [
    element("p", [...students.flatMap((folder, at) => [...(at ? [" · "] : []), named(folder)]), `: ${kind}, `, fill(words.notice_values, { count })]),
  ]);
  if (students.length < 2) return made;
  const details = element("details", [element("summary", words.side_by_side)]);
  details.addEventListener("toggle", () => { if (details.open && details.children.length === 1) compareSheets(details, students); });
  made.append(details);
  return made;
}

// Show the values of two students beside each other, those that agree in all figures marked.
async function compareSheets(details, students) {
  const place = element("div", words.working);
  details.append(place);
  try {
    const sheets = await Promise.all(students.map((folder) => send(`/desk/students/${encodeURIComponent(folder)}/sheet`)));
    const [first, second] = sheets.map(valuesOf);
    const rows = [...first].filter(([key]) => second.has(key)).map(([key, { name, text }]) => {
      const same = second.get(key).text === text;
      return element("tr", [
        element("th", name, { scope: "row" }), element("td", text), element("td", second.get(key).text), element("td", same ? "=" : ""),
      ], { className: same ? "same" : "" });
    });
    place.replaceChildren(element("div", [element("table", [
      element("thead", [element("tr", ["", ...students.map((folder) => student(folder)?.name || folder), ""].map((text) => element("td", text)))]),
      element("tbody", rows),
    ], { className: "desk" })], { className: "scroll", tabIndex: 0, role: "group", ariaLabel: words.side_by_side }));
  } catch (error) {
    place.replaceChildren(error.message);
  }
}

function valuesOf(sheet) {
  const cells = sheet.sections.flatMap((section) => section.rows).flatMap((row) => row.cells.map((cell) => [row, cell]));
  return new Map(cells.filter(([, cell]) => cell.open && cell.text).map(([row, cell]) => [
    `${row.id}@${cell.position}`, { name: cell.label ? `${row.symbol} (${cell.label})` : row.symbol, text: cell.text },
  ]));
}

async function act(path, body, place = by("acting")) {
  place.textContent = words.working;
  try {
    const answer = await send(path, body, 120000);
    place.textContent = "";
    return answer;
  } catch (error) {
    place.textContent = error.message;
    return undefined;
  } finally {
    renew();
  }
}

for (const button of document.querySelectorAll("[data-sort]")) {
  button.addEventListener("click", () => {
    falling = order === button.dataset.sort && !falling;
    order = button.dataset.sort;
    show();
  });
}
search.addEventListener("input", show);
which.addEventListener("change", show);
by("mark").addEventListener("click", async () => {
  if (await act("/desk/mark", {})) { table.marking = true; show(); }
});
by("release").addEventListener("click", () => act("/desk/release", { released: !table.released }));
by("backup").addEventListener("click", async () => {
  by("backup").disabled = true;
  const answer = await act("/desk/backup", {}, by("backed"));
  by("backup").disabled = false;
  if (answer) by("backed").textContent = `${answer.file} (${clock()})`;
});
by("add").addEventListener("submit", async (event) => {
  event.preventDefault();
  const student = Object.fromEntries(new FormData(by("add")));
  const answer = await act("/desk/students", student, by("adding"));
  if (!answer) return;
  by("adding").textContent = fill(words.added, { name: student.name });
  by("add").reset();
});
// The filled table comes as a file, what it has no row for as a header.
by("gradebook").addEventListener("submit", async (event) => {
  event.preventDefault();
  const place = by("filled"), file = by("table").files[0];
  place.textContent = words.working;
  try {
    const answer = await fetch("/desk/gradebook", {
      method: "POST", body: new FormData(by("gradebook")), headers: { Accept: "application/json" }, credentials: "same-origin", redirect: "error",
    });
    if (!answer.ok) throw new Refused(answer.status, await answer.json());
    const address = URL.createObjectURL(await answer.blob());
    element("a", "", { href: address, download: file.name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 60000);
    const lines = JSON.parse(decodeURIComponent(answer.headers.get("X-Problems") ?? "[]"));
    place.replaceChildren(element("p", words.filled_in), ...lines.map((text) => element("p", text, { className: "warning" })));
  } catch (error) {
    place.textContent = error instanceof Refused ? error.message : words.unreachable;
  }
});
// A download may have to be made first: say so as long as it takes.
document.addEventListener("click", ({ target }) => {
  if (!target.matches("[data-download]")) return;
  by("downloading").textContent = words.preparing;
  setTimeout(() => { by("downloading").textContent = ""; }, 8000);
});
show();
notices();
timer = setTimeout(renew, table.marking ? WHILE_MARKING : EVERY);
