"use strict";
// Points of the machine and tips of its loads are pulled with the pointer: the fields that give them follow, and are
// written at the release.  Esc, a second finger and a lost pointer take back.  What there is, and its values, is asked
// of the program.
const pulls = (() => {
  const panel = typeof panels === "undefined" ? undefined : panels[0];
  if (!panel?.root.querySelector('[data-stage="machine"] svg')) return undefined;
  const SLACK = 3, NEAR = 4, FINGER = 24;
  const form = document.getElementById("fields"), words = JSON.parse(document.getElementById("live").textContent).words;
  let grips = { points: {}, ground: {}, loads: {} }, asked = "", held = null, count = 0, unwritten = 0;

  // In what is held, `last` is where the pointer was for the machine that is shown.
  const svg = () => panel.root.querySelector('[data-stage="machine"] svg');
  const at = (name) => extended.get(panel.root).spotAt(name) || grips.ground[name];
  const placeOf = ({ point, load }) => load ? extended.get(panel.root).tipAt(load) : at(point);
  const toDrawing = ({ clientX, clientY }) => {
    const { x, y } = new DOMPoint(clientX, clientY).matrixTransform(svg().getScreenCTM().inverse());
    return [x, y];
  };
  const fieldOf = (where) => {
    const place = [...where];
    while (place.length && !fields.byPlace(place)) place.pop();
    return fields.byPlace(place);
  };
  const element = (name, attributes) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, text] of Object.entries(attributes)) made.setAttribute(key, text);
    return made;
  };

  // --- which points there are

  // Fixed points have nothing else that a pointer meets.
  const mark = () => {
    const drawing = svg(), names = extended.get(panel.root).spots();
    drawing.querySelectorAll(".fixed-grip").forEach((one) => one.remove());
    drawing.querySelectorAll(".spot").forEach((spot) => {
      const name = names[spot.dataset.spot];
      spot.classList.toggle("grip", name in grips.points);
    });
    for (const [name, [cx, cy]] of Object.entries(grips.ground || {})) {
      if (name in grips.points) drawing.append(element("circle", { class: "fixed-grip grip", cx, cy, r: NEAR }));
    }
    document.dispatchEvent(new CustomEvent("gripped", { detail: grips }));
  };
  const learn = async () => {
    const of = document.body.dataset.moving;
    if (asked === of) return;
    asked = of;
    const found = await (await fetch("grips.json", { cache: "no-store" })).json();
    if (asked !== of) return;
    grips = { points: {}, ground: {}, loads: {}, ...found };
    mark();
  };

  // --- the ring about a point, and the values that follow it

  const ring = (place) => {
    let circle = svg().querySelector(".pull-ring");
    if (!circle && place) svg().append(circle = element("circle", { class: "pull-ring", r: 3.4 }));
    if (!place) { circle?.remove(); return; }
    circle.setAttribute("cx", place[0]);
    circle.setAttribute("cy", place[1]);
  };
  const say = (text) => {
    let output = panel.root.querySelector(".pull-values");
    if (!text) { output?.remove(); return; }
    if (!output) {
      output = Object.assign(document.createElement("output"), { className: "pull-values" });
      output.setAttribute("aria-live", "off");
      svg().parentElement.append(output);
    }
    output.textContent = text;
  };
  const named = (field) => {
    const label = field.closest(".field").querySelector("label");
    return (label.querySelector("code") || label).textContent.trim();
  };

  // The nearest point or tip under a pointer; a finger covers more than a mouse.
  const under = (event) => {
    const [x, y] = toDrawing(event), { a } = svg().getScreenCTM();
    const reach = event.pointerType === "touch" ? Math.max(NEAR, FINGER / a) : NEAR;
    let best = null, least = reach;
    const all = [...Object.keys(grips.points).map((point) => ({ point })), ...Object.keys(grips.loads).map((load) => ({ load }))];
    for (const grip of all) {
      const place = placeOf(grip), off = place ? Math.hypot(x - place[0], y - place[1]) : Infinity;
      if (off < least) { best = grip; least = off; }
    }
    return best;
  };

  // --- a pull, from the pointer's press to its release

  const press = (event) => {
    if (held || event.button || !svg()?.contains(event.target) || event.target.closest(".handle")) return;
    const grip = under(event);
    if (!grip) return;
    const playing = panel.playing();
    if (playing) panel.pause();
    held = { grip, playing, id: event.pointerId, from: [event.clientX, event.clientY], moved: false, fields: new Set() };
    ring(placeOf(grip));
  };
  // The point is where it is now while the pointer is at this place of the screen.
  const hold = ([clientX, clientY]) => {
    const place = placeOf(held.grip), [x, y] = toDrawing({ clientX, clientY });
    held.off = [place[0] - x, place[1] - y];
  };
  const begin = () => {
    held.moved = true;
    // The last pull may have moved the point since it was pressed.
    hold(held.from);
    count += 1;
    // What is typed and not yet in the file stays as it is typed.
    const locked = [...typeof locks === "undefined" ? [] : locks.places(), ...drafts.places().map((one) => JSON.parse(one))];
    held.body = { grab: count, ...held.grip, angle: panel.angle(), locked };
    held.typing = drafts.begin();
    panel.root.setPointerCapture(held.id);
    document.body.classList.add("pulling");
    document.dispatchEvent(new CustomEvent("pull", { detail: held.body }));
  };
  // What was typed over a value that was pulled is not the pull's any more.
  const own = ({ typing, fields: changed }) => [...changed].map((field) => field.dataset.w).filter((place) => drafts.typing(place) === typing);
  const move = (event) => {
    if (!held) {
      const grip = event.pointerType !== "touch" && svg()?.contains(event.target) && !event.target.closest(".handle") && !panel.playing() ? under(event) : null;
      if (!svg()) return;
      ring(grip && placeOf(grip));
      svg().classList.toggle("on-tip", Boolean(grip?.load));
      return;
    }
    if (event.pointerId !== held.id) return;
    if (!held.moved && Math.hypot(event.clientX - held.from[0], event.clientY - held.from[1]) < SLACK) return;
    // A pull begins when what the last one changes is in the file.
    if (!held.moved && unwritten) {
      held.waiting = event;
      return;
    }
    if (!held.moved) begin();
    const [x, y] = toDrawing(event), mine = held, from = [event.clientX, event.clientY];
    mine.answered = dragging.ask("pull.json", { ...mine.body, to: [x + mine.off[0], y + mine.off[1]] }, ({ values, at: place }) => {
      // The last answer may come after the release.
      if (held !== mine && !mine.released) return;
      if (place) mine.last = from;
      if (place && !mine.released) ring(place);
      if (!mine.released) document.body.classList.toggle("pull-stopped", !place);
      for (const [where, text] of values) {
        const field = fieldOf(where);
        if (!field || field.value === text || (drafts.typing(field.dataset.w) ?? mine.typing) !== mine.typing) continue;
        fields.type(field, text, mine.typing);
        mine.fields.add(field);
        field.closest(".field").classList.toggle("pulled", !mine.released);
        const bar = field.closest(".field").querySelector("input[type=range]");
        if (bar) bar.value = parseFloat(text.split("/").pop());
      }
      if (!mine.released) say([...mine.fields].map((field) => `${named(field)}: ${field.value}`).join(" · ") || (place ? "" : words.pull_none));
    });
  };
  const end = () => {
    const { moved, playing } = held;
    ring(null);
    say("");
    form.querySelectorAll(".pulled").forEach((one) => one.classList.remove("pulled"));
    document.body.classList.remove("pulling", "pull-stopped");
    held = null;
    if (moved) document.dispatchEvent(new CustomEvent("pull", { detail: null }));
    if (!moved && playing) panel.play();
  };
  const cancel = () => {
    const mine = held;
    end();
    if (mine.moved) fields.takeBack(own(mine));
  };
  // What is clicked on leads to its field; what was pulled has led to it, and a finger that takes back presses nothing.
  const noClick = () => {
    const stop = (click) => { click.stopPropagation(); click.preventDefault(); };
    addEventListener("click", stop, true);
    setTimeout(() => removeEventListener("click", stop, true));
  };
  const release = (event) => {
    if (!held || event.pointerId !== held.id) return;
    const mine = held, { moved, grip, waiting } = mine;
    mine.released = moved;
    end();
    if (!moved && waiting) noClick();
    else if (!moved) {
      if (event.pointerType === "touch") svg().querySelectorAll(".spot")[extended.get(panel.root).spots().indexOf(grip.point)]?.dispatchEvent(new MouseEvent("click"));
    } else {
      noClick();
      unwritten += 1;
      mine.answered.then(() => fields.commitAll(own(mine))).finally(() => {
        unwritten -= 1;
        if (held?.waiting) move(held.waiting);
      });
    }
  };
  // A finger that comes down beside a point pulls it, and does not move the page.
  panel.root.addEventListener("touchstart", (event) => {
    const [touch] = event.changedTouches;
    if (svg()?.contains(touch.target) && under({ clientX: touch.clientX, clientY: touch.clientY, pointerType: "touch" })) event.preventDefault();
  }, { passive: false });
  panel.root.addEventListener("pointerdown", press);
  panel.root.addEventListener("pointermove", move);
  addEventListener("pointerdown", (event) => {
    if (!held?.moved || event.pointerId === held.id) return;
    cancel();
    event.stopPropagation();
    addEventListener("pointerup", ({ pointerId }) => { if (pointerId === event.pointerId) noClick(); }, { once: true });
  }, true);
  addEventListener("pointerup", release);
  addEventListener("pointercancel", (event) => { if (held && event.pointerId === held.id) cancel(); });
  document.addEventListener("closing", () => { if (held?.moved) cancel(); });
  addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !held) return;
    event.preventDefault();
    event.stopPropagation();
    cancel();
  }, true);
  document.addEventListener("showing", () => {
    if (asked === document.body.dataset.moving) return;
    // A pull goes on with the new machine, at the scale of its drawing, if that has its point.
    if (held && !placeOf(held.grip)) cancel();
    if (held?.last) hold(held.last);
    mark();
    learn();
  });
  learn();
  return { at, placeOf, svg, toDrawing, element, noClick, held: () => held !== null };
})();
