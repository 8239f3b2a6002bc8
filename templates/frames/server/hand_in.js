// One student's hand-in beside the key: deadline, link, another variant, and the instructor's own judgement of a value.

import { element, fill, moment, send, words } from "./requests.js";

const base = document.getElementById("student").dataset.path;
const by = (id) => document.getElementById(id);

async function act(path, body, place) {
  place.textContent = words.working;
  try {
    const answer = await send(`${base}/${path}`, body, 120000);
    place.textContent = words.done;
    return answer;
  } catch (error) {
    place.textContent = error.message;
    return undefined;
  }
}

by("deadline").addEventListener("submit", async (event) => {
  event.preventDefault();
  const value = by("new-deadline").value, place = by("deadline").querySelector('[role="status"]');
  const answer = await act("deadline", { closes: value ? value.replace("T", " ") : null }, place);
  if (answer) by("closes").textContent = answer.closes ? moment(answer.closes) : words.closes_never;
});

const file = by("yaml");
file.closest("details").addEventListener("toggle", async () => {
  if (!("empty" in file.dataset)) return;
  try {
    file.value = (await send(`${base}/file`)).yaml;
    delete file.dataset.empty;
  } catch (error) {
    file.value = error.message;
  }
});

const ACTS = {
  link: async (place) => linked(place, await act("link", { renew: false }, place)),
  renew: async (place) => linked(place, await act("link", { renew: true }, place)),
  redraw: async (place) => { if (await act("redraw", {}, place)) location.reload(); },
  fix: async (place) => { if (!("empty" in file.dataset) && (await act("fix", { yaml: file.value }, place))) location.reload(); },
  drop: async (place) => { if (await act("drop", {}, place)) location.href = "/desk"; },
};
const ASKED = new Set(["renew", "redraw", "drop"]);

function linked(place, answer) {
  if (!answer) return;
  place.replaceChildren(
    element("input", [], { readOnly: true, value: answer.link, ariaLabel: words.link, className: "link" }),
    fill(words.with_code, { code: answer.code }),
  );
  place.querySelector("input").select();
}

for (const button of document.querySelectorAll("[data-act]")) {
  button.addEventListener("click", async () => {
    const place = button.parentElement.querySelector('[role="status"]'), name = button.dataset.act;
    // What cannot be undone is asked for twice.
    if (ASKED.has(name) && button.dataset.sure !== "yes") {
      button.dataset.sure = "yes";
      place.textContent = words.sure;
      setTimeout(() => { delete button.dataset.sure; }, 8000);
      return;
    }
    delete button.dataset.sure;
    button.disabled = true;
    await ACTS[name](place);
    button.disabled = false;
  });
}

const WRONG = new Set(["wrong", "follows", "unread"]);
by("which").addEventListener("change", () => {
  const only = { all: () => true, wrong: (row) => WRONG.has(row.dataset.verdict), filled: (row) => row.cells[1].textContent.trim() }[by("which").value];
  for (const row of document.querySelectorAll("#cells tr[data-id]")) row.hidden = !only(row);
});

const dialog = by("judging"), said = by("judging-state");
let judged;
document.addEventListener("click", ({ target }) => {
  if (!target.matches("[data-judge]")) return;
  judged = target.closest("tr");
  by("judged").textContent = judged.querySelector("th .symbol").textContent + (judged.querySelector("th .unit")?.textContent ?? "");
  said.textContent = "";
  by("name").value ||= localStorage.getItem("reportgen:judge") ?? "";
  dialog.showModal();
});
by("cancel").addEventListener("click", () => dialog.close());
dialog.querySelector("form").addEventListener("submit", async (event) => {
  event.preventDefault();
  const { judgement, reason, name } = Object.fromEntries(new FormData(event.target));
  const { id, position } = judged.dataset;
  try {
    localStorage.setItem("reportgen:judge", name);
  } catch {
    // The name is asked for again.
  }
  if (await act("correct", { id, position: Number(position), judgement, reason, name, text: judged.cells[1].textContent.trim() }, said)) {
    judged.querySelector(".verdict").textContent = `${words.verdicts[judgement]} (${words.at_next_marking})`;
    dialog.close();
  }
});
