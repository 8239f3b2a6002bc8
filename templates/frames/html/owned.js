"use strict";
// A field and its link: each leads to the other.  What belongs to what is asked of the program.
(() => {
  const { byPlace } = fields, form = document.getElementById("fields"), machine = typeof panels === "undefined" ? undefined : panels[0];
  if (!machine) return;

  const NEAR = 4;
  let owners = { fields: [], ground: {} }, marked = [], following = false;
  const svg = () => machine.root.querySelector('[data-stage="machine"] svg');
  const at = (name) => extended.get(machine.root).spotAt(name) || owners.ground[name];
  const overlay = () => {
    const drawing = svg();
    let path = drawing.querySelector(".own");
    if (!path) {
      path = document.createElementNS("http://www.w3.org/2000/svg", "path");
      path.setAttribute("class", "own");
      drawing.append(path);
    }
    return path;
  };
  const follow = () => {
    // As long as anything is marked it goes with what moves.
    if (marked.length && !following) {
      following = true;
      requestAnimationFrame(() => { following = false; follow(); });
    }
    if (!marked.length && !svg()?.querySelector(".own")) return;
    const bars = marked.flatMap(({ bars }) => bars).map((names) => names.map(at)).filter((ends) => ends.every(Boolean));
    const points = marked.flatMap(({ points }) => points).map(at).filter(Boolean);
    const ring = ([x, y]) => `M${x - 3} ${y}a3 3 0 1 0 6 0a3 3 0 1 0 -6 0`;
    overlay().setAttribute("d", bars.map(([a, b]) => `M${a}L${b}`).join("") + points.map(ring).join(""));
  };
  const same = (one, where) => one.where.length >= where.length && where.every((step, index) => one.where[index] === step);
  const mark = (field) => {
    marked = field?.dataset?.w ? owners.fields.filter((one) => same(one, JSON.parse(field.dataset.w))) : [];
    follow();
  };
  const learn = async () => {
    owners = await (await fetch("owners.json", { cache: "no-store" })).json();
    mark(document.activeElement?.closest?.(".field")?.querySelector("[data-w]"));
  };
  form.addEventListener("focusin", (event) => mark(event.target.closest(".field")?.querySelector("[data-w]")));
  form.addEventListener("focusout", () => mark(null));
  form.addEventListener("pointerover", (event) => {
    const field = event.target.closest(".field")?.querySelector("[data-w]");
    if (field) mark(field);
  });
  // Those fields whose bar or point is under the pointer.
  const under = (event) => {
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg().getScreenCTM().inverse());
    const toPoint = (name) => { const p = at(name); return p ? Math.hypot(x - p[0], y - p[1]) : Infinity; };
    const toBar = ([from, to]) => {
      const a = at(from), b = at(to);
      if (!a || !b) return Infinity;
      const dx = b[0] - a[0], dy = b[1] - a[1], share = ((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy || 1);
      const t = Math.min(Math.max(share, 0), 1);
      return Math.hypot(x - a[0] - t * dx, y - a[1] - t * dy);
    };
    return owners.fields.filter(({ bars, points }) => Math.min(...bars.map(toBar), ...points.map(toPoint)) < NEAR);
  };
  const fieldsOf = (list) => list.map(({ where }) => {
    const place = [...where];
    while (place.length && !byPlace(place)) place.pop();
    return byPlace(place);
  });
  machine.root.addEventListener("pointermove", (event) => {
    const list = svg()?.contains(event.target) ? under(event) : [];
    const own = new Set(fieldsOf(list).map((one) => one?.closest(".field")));
    form.querySelectorAll(".field.own").forEach((one) => { if (!own.has(one)) one.classList.remove("own"); });
    own.forEach((one) => one?.classList.add("own"));
  });
  machine.root.addEventListener("click", (event) => {
    if (svg()?.contains(event.target)) fieldsOf(under(event))[0]?.focus();
  });
  document.addEventListener("redrawn", learn);
  learn();
})();
