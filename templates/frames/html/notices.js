"use strict";
// Notices of the form: why something was refused, what is being made.  They stand beside the fields, never over them, are
// closed by their button or by Esc, and go when the file has changed since.
const notices = (() => {
  const fields = document.getElementById("fields"), box = document.getElementById("notices");
  const words = JSON.parse(document.getElementById("live").textContent).words;
  const notice = (said) => said.closest(".notice");
  const open = () => [...box.querySelectorAll(".notice.open")];
  let last = null, closed = "", told = "", known = "", first = true;

  const isSeen = (field) => {
    const { left, top, width, height } = field.getBoundingClientRect();
    return field.contains(document.elementFromPoint(left + width / 2, top + height / 2));
  };
  // Where the machine stays above the fields, a notice is laid over the machine.
  const place = () => {
    const strip = open().length > 0 && document.body.classList.contains("kept") && document.querySelector(".moving.held");
    if (!strip) return;
    const { top, height } = strip.getBoundingClientRect();
    box.style.setProperty("--strip-top", `${Math.max(top, 0)}px`);
    box.style.setProperty("--strip-height", `${height}px`);
  };
  addEventListener("scroll", place, { passive: true });
  addEventListener("resize", place);

  // The field in which one types stays in sight, whatever appears.
  const inSight = (act) => {
    const field = fields.contains(document.activeElement) && document.activeElement, seen = field && isSeen(field);
    act();
    if (seen && field === document.activeElement && !isSeen(field)) field.scrollIntoView({ block: "nearest" });
  };
  const say = (id, ...content) => inSight(() => {
    const said = document.getElementById(id);
    said.replaceChildren(...content.filter((one) => one !== ""));
    notice(said).classList.toggle("open", said.hasChildNodes());
    place();
  });
  const close = (one) => {
    const said = one.firstElementChild, inside = one.contains(document.activeElement);
    if (said.id === "making") closed = told;
    say(said.id);
    if (inside && last?.isConnected) last.focus({ preventScroll: true });
  };
  fields.addEventListener("focusin", ({ target }) => { last = target; });
  box.addEventListener("click", ({ target }) => { if ("close" in target.dataset) close(notice(target)); });
  document.addEventListener("keydown", (event) => {
    const uppermost = open().at(-1);
    if (event.key !== "Escape" || event.defaultPrevented || !uppermost) return;
    event.preventDefault();
    close(uppermost);
  });

  const link = ([name, path]) => Object.assign(document.createElement("a"), { href: `made/${encodeURIComponent(name)}`, target: "_blank", textContent: path });
  const cancel = () => {
    const button = Object.assign(document.createElement("button"), { type: "button", textContent: words.end });
    button.addEventListener("click", () => make({ end: true }));
    return button;
  };
  const tellMaking = (making) => {
    told = making ? JSON.stringify([making.product, making.state]) : "";
    const is = making?.state, old = first && is !== "running";
    first = false;
    if (!making || old || closed === told) {
      say("making");
      return;
    }
    closed = "";
    const step = making.step ? ` ${words.steps[making.step]}` : "";
    say(
      "making",
      `${words.products[making.product]}: ${words.states[is]}${step} `,
      ...(making.files || []).flatMap((file) => [link(file), " "]),
      making.complaint ? Object.assign(document.createElement("pre"), { textContent: making.complaint }) : "",
      is === "running" ? cancel() : "",
    );
  };
  document.addEventListener("news", ({ detail }) => {
    const now = JSON.stringify(detail.making ?? null);
    if (now !== known) tellMaking(detail.making);
    known = now;
  });
  // Asks for a product, or for the end of what is being made.
  const make = async (body) => {
    closed = "";
    try {
      const answer = await fetch("make.json", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });
      if (answer.ok) return;
    } catch { /* said below */ }
    say("refused", words.lost);
  };
  return { say, make, inSight };
})();
