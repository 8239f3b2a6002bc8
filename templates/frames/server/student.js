// The rest of a student's page: the machine moving in a frame, and uploads with their receipts.

import { data, element, errors, fill, moment, newId, number, send, size, words } from "./requests.js";

const moving = document.getElementById("moving");
moving?.addEventListener("toggle", () => {
  const frame = moving.querySelector("iframe");
  if (moving.open && !frame.src) frame.src = moving.dataset.src;
});

const form = document.getElementById("upload"), said = document.getElementById("uploading");
const list = document.getElementById("receipts"), left = document.getElementById("uploads-left");
const file = form?.querySelector('input[type="file"]');
const shown = new Map();
// A file that is sent again keeps its id, so that the server stores it once.
let client = newId();
file?.addEventListener("change", () => { client = newId(); });

form?.addEventListener("submit", async (event) => {
  event.preventDefault();
  const button = form.querySelector("button");
  // The server would end the connection before the browser reads why.
  if (file.files[0].size > Number(form.dataset.largest)) {
    said.textContent = errors.file_too_large;
    return;
  }
  button.disabled = true;
  said.textContent = words.uploading;
  try {
    const body = new FormData();
    body.append("client", client);
    body.append("file", file.files[0]);
    const receipt = await send("/me/uploads", body, 300000);
    said.textContent = words.upload_done;
    put(receipt);
    form.reset();
    client = newId();
    renew();
  } catch (error) {
    said.textContent = error.message;
  }
  button.disabled = false;
});

function put(receipt) {
  const pair = (label, value, look = "") => element("div", [element("dt", label), element("dd", value, { className: look })]);
  const status = receipt.state === "queued" ? fill(words.states.queued, { count: receipt.queue ?? 0 }) : words.states[receipt.state];
  const made = element("li", [
    element("a", receipt.name, { href: `/me/uploads/${receipt.number}/file` }),
    element("span", ` ${size(receipt.size)}`, { className: "unit" }),
    element("dl", [
      pair(words.received, moment(receipt.at)),
      pair("SHA-256", receipt.sha256, "digest"),
      pair(words.read, [status, ...(receipt.earlier ? [element("span", words.earlier_variant, { className: "line" })] : []), ...receipt.lines.map((line) => element("span", line, { className: "line" }))]),
    ]),
  ]);
  const standing = shown.get(receipt.number);
  if (standing) standing.replaceWith(made);
  else list.prepend(made);
  shown.set(receipt.number, made);
}

// Ask again until every upload has been read.
async function renew() {
  try {
    const state = await send("/me/state?since=999999999999999");
    state.uploads.forEach(put);
    if (left && Number.isInteger(state.uploads_left)) left.textContent = fill(words.uploads_left, { count: state.uploads_left });
    if (state.uploads.some((one) => one.state === "queued")) setTimeout(renew, 1500);
  } catch (error) {
    if (error.again) setTimeout(renew, 5000);
  }
}

// --- the mark, after its release ------------------------------------------------------------------

const marked = document.getElementById("marked"), names = data("file-names");

async function showResult() {
  try {
    const result = await send("/me/result");
    marked.replaceChildren(
      ...(result.mark === null ? [element("p", words.no_mark)] : [
        element("p", [element("strong", number(result.mark)), ` / ${number(result.highest)}`], { className: "mark" }),
        element("p", fill(words.points, { points: number(result.points), out_of: number(result.out_of) })),
      ]),
      ...(result.lines ?? []).map((line) => element("p", line)),
      element("ul", (result.files ?? []).map((name) => element("li", [
        element("a", names[name] ?? name, { href: `/me/result/${encodeURIComponent(name)}` }),
      ])), { className: "links" }),
    );
  } catch (error) {
    marked.textContent = error.status === 404 ? words.no_mark : error.message;
  }
}

if (marked) showResult();

const uploads = data("uploads") ?? [];
uploads.forEach(put);
if (uploads.some((one) => one.state === "queued")) renew();
