"use strict";
// The form of the file: what is typed becomes a draft, a draft goes to the file, and the form shows the file with the
// drafts laid over it.
const fields = (() => {
  const form = document.getElementById("fields"), words = JSON.parse(document.getElementById("live").textContent).words;
  const machine = typeof panels === "undefined" ? undefined : panels[0];
  const PAUSE = 2000, REST = 1000, KEEP = `reportgen-form${location.pathname}`;
  const place = (element) => JSON.parse(element.closest("[data-w]").dataset.w);
  const byPlace = (where) => [...form.querySelectorAll("input[data-w], select[data-w], fieldset[data-w]")].find((one) => JSON.stringify(place(one)) === JSON.stringify(where));
  const ofKey = (key, root = form) => [...root.querySelectorAll("[data-was]")].find((one) => one.dataset.w === key);
  const isNumber = (input) => input.type !== "range" && ("unit" in input.dataset || "number" in input.dataset);

  // --- numbers with their units

  // A number as typed, the lower one of a ratio as 1/3.6: what stands before it, its digits, its unit.
  const DIGITS = "[+-]?(?:\\d+\\.?\\d*|\\.\\d+)(?:[eE][+-]?\\d+)?", TYPED = new RegExp(`^\\s*(${DIGITS}\\s*/\\s*)?(${DIGITS})(.*)$`);
  const typed = (text) => {
    const [, over = "", digits, unit] = TYPED.exec(text) || [];
    return digits && { over, digits, unit, number: Number(digits) };
  };
  // As it is written to the file: no more figures than it needs, never a thousand that looks like decimals.
  const written = ({ over, unit }, number, figures) => `${over}${Number(number.toPrecision(figures))}${unit}`;
  const within = (input, { over, unit }, number) => {
    // Bounds are those in the unit of the field; in another one they are left to the program.
    if (input.dataset.unit && unit.trim() !== input.dataset.unit) return number;
    const low = Number(input.dataset.low ?? -Infinity), high = Number(input.dataset.high ?? Infinity);
    const bounded = (value) => Math.min(Math.max(value, low), high);
    return over ? parseFloat(over) / bounded(parseFloat(over) / number) : bounded(number);
  };
  const stepped = (input, sense) => {
    const parts = typed(input.value);
    if (!parts) return null;
    const { number, digits } = parts, decimals = (digits.split(".")[1] || "").length;
    const step = 10 ** -decimals * (Math.abs(number) >= 100 && !decimals ? 5 : 1);
    return written(parts, within(input, parts, Number((number + sense * step).toFixed(decimals))), 7);
  };
  const slider = (input) => {
    const parts = typed(input.value);
    if (!parts) return;
    const { number } = parts, reach = Math.abs(number) / 2 || 10, bar = document.createElement("input");
    bar.type = "range";
    bar.min = within(input, parts, number - reach);
    bar.max = within(input, parts, number + reach);
    bar.step = Number((reach / 100).toPrecision(1));
    bar.value = number;
    bar.setAttribute("aria-label", `${words.slide}: ${input.closest(".field").querySelector("label").textContent}`);
    input.closest(".box").after(bar);
  };
  const ofSlider = (bar) => bar.closest(".field").querySelector("input[data-w]");

  // --- what is shown: the newest form of the file, the drafts over it

  let html = "", revision = 0, pasted = null, held = false, behind = false, strays = false, orphans = "[]";
  const elements = () => {
    const next = document.createElement("div");
    next.innerHTML = html;
    tables.grids(next);
    return next;
  };
  const values = (next) => new Map([...next.querySelectorAll("[data-was]")].map((one) => [one.dataset.w, one.dataset.was]));
  const note = (key, { mine, there }) => {
    const element = document.createElement("p");
    element.className = "conflict";
    element.setAttribute("role", "alert");
    element.textContent = words.both.replace("{mine}", mine).replace("{there}", there || "–");
    for (const [act, text] of [["mine", words.mine], ["theirs", words.theirs]]) {
      const button = document.createElement("button");
      Object.assign(button, { type: "button", textContent: text });
      Object.assign(button.dataset, { settle: act, of: key });
      element.append(" ", button);
    }
    return element;
  };
  // What was typed into a field that the file no longer has is kept until it is discarded, or until the field is back.
  const orphan = (key) => {
    const element = document.createElement("p"), button = document.createElement("button");
    element.textContent = words.orphan.replace("{mine}", drafts.text(key)).replace("{key}", JSON.parse(key).join("."));
    Object.assign(button, { type: "button", textContent: words.discard });
    button.addEventListener("click", () => {
      drafts.drop(key);
      notices.say("refused");
      show();
    });
    element.append(" ", button);
    return element;
  };
  const show = () => {
    if (held) {
      behind = true;
      return;
    }
    const next = elements();
    for (const key of drafts.places()) {
      const field = ofKey(key, next), parted = drafts.conflict(key);
      if (!field) continue;
      field.value = drafts.text(key);
      if (parted) (field.closest(".box") || field).after(note(key, parted));
    }
    const cell = pasted && ofKey(pasted.key, next);
    if (cell) (cell.closest(".tabled") || cell.closest(".box")).after(pasting.question(pasted.doubt, words));
    next.querySelectorAll("input[data-unit], input[data-number]").forEach(slider);
    document.dispatchEvent(new CustomEvent("forming", { detail: next }));
    next.querySelector("#saved").textContent = status();
    const active = document.activeElement, lost = form.contains(active) && active.closest(".field")?.dataset.key;
    notices.inSight(() => { strays = redraw(form, next); });
    // A notice of them that is closed comes back only when there is more or less to say.
    const gone = drafts.places().filter((key) => !ofKey(key)), list = JSON.stringify(gone.map((key) => [key, drafts.text(key)]));
    if (list !== orphans) notices.say("orphans", ...gone.map(orphan));
    orphans = list;
    // The button of a field that is elsewhere now: its field has the focus.
    keep();
    const again = lost && !active.isConnected && document.getElementById(lost);
    if (again) reach(again);
    document.body.classList.toggle("stale", Boolean(form.querySelector("#problems ul")));
  };
  // Keys that are typed along do not come to a button that has just appeared: Tab leads to it when they rest.
  const known = new WeakSet(), fresh = new Set();
  let rest = 0;
  const keep = () => {
    for (const button of form.querySelectorAll("button")) {
      if (!known.has(button)) fresh.add(button);
      known.add(button);
      if (fresh.has(button)) button.tabIndex = -1;
    }
    clearTimeout(rest);
    rest = setTimeout(() => {
      fresh.forEach((button) => button.removeAttribute("tabindex"));
      fresh.clear();
    }, REST);
  };
  // A click goes to what the pointer was pressed on: nothing slides under it.
  const hold = () => { held = true; };
  const release = () => setTimeout(() => {
    held = false;
    if (behind) show();
    behind = false;
  });
  addEventListener("pointerdown", hold, true);
  for (const name of ["pointerup", "pointercancel"]) addEventListener(name, release, true);
  addEventListener("blur", ({ target }) => { if (target === window) release(); });

  // --- what is sent: one change after the other

  const outbox = [];
  let work = Promise.resolve(), sending = false, waiting = false, building = false, lost = false;
  const status = () => (waiting ? words.saving : lost || drafts.places().length ? words.unsaved : words.saved);
  const tell = () => { document.getElementById("saved").textContent = status(); };
  // Returns whether the file has other values than before.
  const receive = (answer, how) => {
    if (answer.revision < revision) return false;
    [html, revision] = [answer.form, answer.revision];
    return drafts.learn(values(elements()), how);
  };
  const asked = async (body) => {
    waiting = true;
    tell();
    try {
      const answer = await post("edit.json", body);
      return answer.ok ? await answer.json() : null;
    } catch {
      return null;
    } finally {
      waiting = false;
    }
  };
  drafts.sureIf(() => !outbox.length && !waiting);
  const send = async () => {
    sending = true;
    while (outbox.length) {
      const { make, done } = outbox.shift(), body = make();
      if (!body) continue;
      const answer = await asked(body), said = answer || { refused: words.lost_edit };
      lost = !answer;
      if (answer) receive(answer, { own: !answer.refused && body.op !== "set" && body.op !== "set all", again: !answer.refused });
      done?.(said);
      const key = JSON.stringify(body.where);
      // Beside a field that shows both values there is no more to say.
      notices.say("refused", said.meanwhile !== undefined && drafts.places().some((one) => one === key && ofKey(one)) ? "" : said.refused || "");
      // What waited for another change of the file can be written now.
      outbox.push(...settings(drafts.due()));
      show();
    }
    sending = false;
    tell();
  };
  const push = (...changes) => {
    outbox.push(...changes);
    if (!sending && outbox.length) work = send();
  };
  const altering = (key, entry) => {
    const change = drafts.send(key, entry), field = ofKey(key);
    return change && { where: JSON.parse(key), ...change, ...(field && "list" in field.dataset ? { list: true } : {}) };
  };
  const setting = ([key, entry]) => ({
    make: () => {
      const change = altering(key, entry);
      return change && { op: "set", ...change };
    },
    done: ({ refused, written: there }) => (refused ? drafts.unwritten(key) : drafts.written(key, there)),
  });
  // What belongs together is written, and undone, as one change, or not at all.
  const together = (due) => {
    let sent = [];
    return {
      make: () => {
        if (due.some(([key]) => drafts.conflict(key))) return null;
        sent = due.map(([key, entry]) => [key, altering(key, entry)]).filter(([, change]) => change);
        return sent.length && { op: "set all", typing: sent[0][1].typing, changes: sent.map(([, change]) => change) };
      },
      done: ({ refused, written: there }) => sent.forEach(([key], index) => (refused ? drafts.unwritten(key) : drafts.written(key, there[index]))),
    };
  };
  const settings = (due) => [...Map.groupBy(due, ([, { typing }]) => typing).values()].map((all) => all.length > 1 ? together(all) : setting(all[0]));
  // What changes which fields there are is asked for by what is shown: a second click before the answer is no second change.
  const build = (make, done = () => {}) => {
    if (building) return;
    building = true;
    push({ make, done: (said) => { building = false; done(said); } });
  };
  const type = (field, text = field.value, typing = undefined) => {
    if (field.value !== text) field.value = text;
    // What is pulled follows on the file, of which the form may not show the last change before the release.
    const { w, was } = field.dataset;
    drafts.typed(w, text, typing === undefined ? was : drafts.there(w) ?? was, typing);
    tell();
  };
  const commit = (field) => {
    clearTimeout(pause);
    const entry = drafts.commit(field.dataset.w);
    tell();
    push(...settings(drafts.due()));
    // What moves takes a number at once, before all is made anew from the file.
    if (entry && isNumber(field)) drag(field);
  };
  let pause = 0;
  const soon = (field) => {
    clearTimeout(pause);
    pause = setTimeout(() => commit(field), PAUSE);
  };

  const drag = (input) => dragging.ask("drag.json", { where: place(input), value: input.value });
  const takeBack = (keys) => {
    keys.forEach(drafts.drop);
    dragging.takeBack();
    show();
  };
  // Returns when it is written, or refused.
  const commitAll = (places) => {
    const due = places.map((key) => [key, drafts.commit(key)]).filter(([, entry]) => entry);
    if (due.length) push(together(due));
    return work;
  };

  // --- what is done

  form.addEventListener("focusin", () => drafts.begin());
  form.addEventListener("focusout", ({ target }) => {
    if ("was" in target.dataset) commit(target);
    // Where it stayed only for its focus, the form is shown as it is.
    if (strays) setTimeout(show);
  });
  form.addEventListener("input", ({ target }) => {
    const field = target.type === "range" ? ofSlider(target) : target;
    if (!("was" in field.dataset)) return;
    if (target.type === "range") {
      type(field, written(typed(field.value), Number(target.value), 4));
      drag(field);
      return;
    }
    type(field);
    if (drafts.conflict(field.dataset.w)) show();
    soon(field);
  });
  form.addEventListener("change", ({ target }) => {
    const field = target.type === "range" ? ofSlider(target) : target;
    if (!("was" in field.dataset)) return;
    commit(field);
    drafts.begin();
  });
  form.addEventListener("keydown", (event) => {
    const input = event.target;
    if (input.closest(".tabled") && "was" in input.dataset && tables.go(event)) {
      event.preventDefault();
      return;
    }
    if (!("was" in input.dataset)) return;
    if (event.key === "Enter" && !event.isComposing) {
      commit(input);
      drafts.begin();
    }
    if (event.key === "Escape" && drafts.isOpen(input.dataset.w)) {
      event.preventDefault();
      takeBack([input.dataset.w]);
    }
    const sense = isNumber(input) && { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
    const next = sense ? stepped(input, sense) : null;
    if (next === null) return;
    event.preventDefault();
    type(input, next);
    soon(input);
    drag(input);
  });
  form.addEventListener("paste", (event) => {
    const cells = event.clipboardData.getData("text"), { target } = event, list = "list" in target.dataset;
    if (!list && !target.closest(".tabled") || !pasting.isCells(cells, list)) return;
    event.preventDefault();
    paste({ cells, key: target.dataset.w });
  });
  const paste = ({ cells, key, decimal }) => {
    const read = pasting.read(cells, decimal), cell = ofKey(key);
    pasted = read.doubt && { key, doubt: read.doubt };
    if (pasted || !cell) {
      show();
      return;
    }
    drafts.begin();
    if (!cell.closest(".tabled")) {
      const items = read.cells.flat().filter(Boolean).join(", ");
      cell.setRangeText(items, cell.selectionStart, cell.selectionEnd, "end");
      type(cell);
      commit(cell);
    }
    // The cells take the place of what was begun to be typed in the first one.
    if (cell.closest(".tabled") && drafts.isOpen(key)) drafts.drop(key);
    const { changes, said } = cell.closest(".tabled") ? tables.pasted(read, cell, typed) : { changes: [], said: read.turned ? words.commas : "" };
    for (const change of changes) {
      drafts.typed(...change);
      drafts.commit(change[0]);
    }
    drafts.begin();
    push(...settings(drafts.due()), { make: () => { if (said) notices.say("refused", said); show(); return null; } });
  };
  const reach = (field) => {
    for (let node = field.closest("details"); node; node = node.parentElement.closest("details")) node.open = true;
    field.focus();
  };
  const goTo = (where) => {
    while (where.length && !byPlace(where)) where.pop();
    const target = byPlace(where), field = target?.matches("fieldset") ? target.querySelector("[data-w]") : target;
    if (field) reach(field);
  };
  form.addEventListener("click", (event) => {
    const button = event.target.closest("button");
    if (!button) return;
    const data = button.dataset, field = button.closest(".field")?.querySelector("[data-w]"), where = button.closest("[data-w]");
    if (button.id === "undo" || button.id === "redo") push({ make: () => ({ op: button.id }) });
    else if ("remedy" in data) {
      drafts.begin();
      type(field, data.remedy);
      commit(field);
    } else if ("reading" in data && pasted) paste({ key: pasted.key, ...pasted.doubt.means[data.reading] });
    else if ("settle" in data) {
      notices.say("refused");
      if (data.settle === "mine") {
        drafts.keepMine(data.of);
        push(...settings(drafts.due()));
      } else takeBack([data.of]);
      ofKey(data.of)?.focus();
      show();
    } else if ("remove" in data) {
      const gone = place(field || button);
      build(() => ({ op: "remove", where: gone }), ({ refused }) => { if (field && !refused) drafts.drop(field.dataset.w); });
    } else if ("make" in data) notices.make({ product: data.make });
    else if ("add" in data) {
      const list = place(where);
      build(() => ({ op: "add", where: list }));
    } else if ("part" in data) {
      const kind = document.getElementById("part").value;
      build(() => ({ op: "add", where: ["parts"], kind }));
    } else if ("up" in data) {
      const list = place(where), index = list.pop();
      build(() => ({ op: "move", where: list, first: index - 1 }));
    } else if ("instead" in data) build(() => ({ op: "instead", where: place(field), key: data.instead, was: ofKey(field.dataset.w)?.dataset.was ?? "", value: data.value || "" }));
    else if ("goto" in data) goTo(JSON.parse(data.goto));
  });
  document.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey || event.key.toLowerCase() !== "z" && event.key.toLowerCase() !== "y") return;
    // What is being typed is the browser's to undo.
    if (event.target.matches("input") && drafts.isOpen(event.target.dataset.w)) return;
    event.preventDefault();
    const op = event.key.toLowerCase() === "y" || event.shiftKey ? "redo" : "undo";
    push({ make: () => ({ op }) });
  });

  // --- what another tab or an editor has written

  document.addEventListener("news", async ({ detail }) => {
    // A server that is there again may not have heard of the last change.
    if (!detail.changed && !lost) return;
    // The answer to a change of one's own says what it has changed.
    await work;
    // What was refused was so in an older file; a machine made anew of the same values is none.
    if (receive(await (await fetch("form.json", { cache: "no-store" })).json())) notices.say("refused");
    show();
    push(...settings(drafts.due()));
    document.dispatchEvent(new Event("redrawn"));
  });

  // --- a page that is loaded anew, or closed

  let last = 0;
  addEventListener("keydown", () => {
    last = Date.now();
    if (fresh.size) keep();
  }, true);
  const resting = async () => { while (sending || Date.now() - last < PAUSE) await new Promise((done) => setTimeout(done, 50)); };
  document.addEventListener("leaving", ({ detail }) => detail.push(resting()));
  addEventListener("pagehide", () => {
    // What is still pulled is taken back first.
    document.dispatchEvent(new Event("closing"));
    const { id, selectionStart: from, selectionEnd: to } = form.contains(document.activeElement) ? document.activeElement : {};
    try { sessionStorage.setItem(KEEP, JSON.stringify({ drafts: drafts.kept(), id, from, to })); } catch { /* no memory */ }
    for (const key of drafts.places()) {
      const { make } = setting([key, drafts.commit(key)]), body = make();
      if (body) post("edit.json", body, { keepalive: true });
    }
  });
  form.querySelectorAll("button").forEach((button) => known.add(button));
  html = form.innerHTML;
  let kept = {};
  try {
    kept = JSON.parse(sessionStorage.getItem(KEEP)) || {};
    sessionStorage.removeItem(KEEP);
  } catch { /* no memory */ }
  drafts.restore(kept.drafts || []);
  drafts.learn(values(elements()));
  show();
  const left = kept.id && document.getElementById(kept.id);
  if (left) reach(left);
  if (left && typeof kept.from === "number" && typeof left.selectionStart === "number") left.setSelectionRange(kept.from, kept.to);
  // Where there is no room beside the form, the machine stays above it.
  if (matchMedia("(max-width: 61.99rem)").matches && machine) {
    machine.hold(true);
    document.body.classList.add("kept");
  }
  push(...settings(drafts.due()));
  return { keep, byPlace, reach, build, type, takeBack, commitAll };
})();
