"use strict";
// The form of the file: what is typed goes to the file, what comes back is the form of the file as it then is.
(() => {
  const form = document.getElementById("fields"), pane = document.getElementById("form"), words = JSON.parse(document.getElementById("live").textContent).words;
  const machine = typeof panels === "undefined" ? undefined : panels[0];
  const post = (name, body) => fetch(name, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });
  const place = (element) => JSON.parse(element.closest("[data-w]").dataset.w);
  const byPlace = (where) => [...form.querySelectorAll("input[data-w], select[data-w], fieldset[data-w]")].find((one) => JSON.stringify(place(one)) === JSON.stringify(where));

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
    const { number } = parts, reach = Math.abs(number) / 2 || 10;
    const bar = document.createElement("input");
    bar.type = "range";
    bar.min = within(input, parts, number - reach);
    bar.max = within(input, parts, number + reach);
    bar.step = Number((reach / 100).toPrecision(1));
    bar.value = number;
    bar.setAttribute("aria-label", `${words.slide}: ${input.labels[0].textContent}`);
    const value = () => written(parts, Number(bar.value), 4);
    bar.addEventListener("input", () => { input.value = value(); drag(input); });
    bar.addEventListener("change", () => { input.value = value(); commit(input); });
    input.closest(".field").querySelector(".box").after(bar);
  };

  // --- changes: one after the other, the newest value of a place wins

  let queue = Promise.resolve();
  const change = (body) => (queue = queue.then(async () => {
    document.getElementById("saved").textContent = words.saving;
    try {
      const answer = await post("edit.json", body);
      if (!answer.ok) throw new Error(answer.status);
      show(await answer.json());
    } catch {
      document.getElementById("refused").textContent = words.lost_edit;
      document.getElementById("saved").textContent = words.unsaved;
    }
  }));
  const commit = (input) => {
    if (input.value === input.dataset.was) return;
    const body = { op: "set", where: place(input), value: input.value, was: input.dataset.was };
    if ("list" in input.dataset) body.list = true;
    input.dataset.was = input.value;
    change(body);
    // What moves takes a number at once, before all is made anew from the file.
    if ("unit" in input.dataset || "number" in input.dataset) drag(input);
  };

  // While a slider is drawn, only what moves follows: the newest value is asked for when the last one is there.
  let wanted = null, asking = false;
  const drag = async (input) => {
    wanted = { where: place(input), value: input.value };
    if (asking) return;
    asking = true;
    while (wanted) {
      const body = wanted;
      wanted = null;
      try {
        const answer = await post("drag.json", body);
        if (answer.headers.get("Content-Type") === "application/json") continue;
        const samples = answer.ok ? await answer.arrayBuffer() : null, known = samples && samples.byteLength > 0;
        document.body.classList.toggle("stale", !known);
        if (!known) continue;
        const length = new DataView(samples).getUint32(0, true);
        const changes = JSON.parse(new TextDecoder().decode(new Uint8Array(samples, 4, length)));
        // Changes of another machine than the page shows are no changes of that; its own come with the next value.
        if (String(changes.of) !== document.body.dataset.moving) continue;
        extended.get(machine?.root)?.feed(new Float32Array(samples, 4 + length), changes);
        document.body.dataset.drawn = body.value;
      } catch { /* the server tells of itself */ }
    }
    asking = false;
  };

  // --- the form anew: what is open stays open, what has the focus keeps it

  const show = ({ form: body, refused, meanwhile }, told = []) => {
    const focused = form.contains(document.activeElement) ? document.activeElement : null;
    const id = focused && (focused.id || focused.closest(".field")?.querySelector("[data-w]")?.id);
    const inBar = focused?.type === "range", typed = focused?.value, was = focused?.dataset?.was;
    const range = focused && focused.selectionStart;
    const open = new Set([...form.querySelectorAll("details[open]")].map((one) => one.dataset.open));
    const top = pane.scrollTop;
    form.innerHTML = body;
    document.getElementById("refused").append(...told);
    mount();
    for (const one of form.querySelectorAll("details")) one.open = open.has(one.dataset.open);
    pane.scrollTop = top;
    let again = id && document.getElementById(id);
    if (again) {
      // What is being typed is not taken away.
      if (typed !== undefined && !inBar && again.dataset.was === was && typed !== was) again.value = typed;
      if (inBar) again = again.closest(".field").querySelector('[type="range"]') || again;
      for (let node = again.closest("details"); node; node = node.parentElement.closest("details")) node.open = true;
      again.focus({ preventScroll: true });
      try { if (!inBar && range !== null) again.setSelectionRange(range, range); } catch { /* no text */ }
    }
    if (refused) document.getElementById("refused").textContent = refused;
    if (meanwhile !== undefined && again) {
      const use = document.createElement("button");
      use.type = "button";
      use.textContent = `${words.mine} ${typed}`;
      use.addEventListener("click", () => { again.value = typed; commit(again); });
      document.getElementById("refused").append(" ", use);
    }
    document.getElementById("saved").textContent = refused ? words.unsaved : words.saved;
    document.body.classList.toggle("stale", Boolean(form.querySelector("#problems ul")));
  };
  const mount = () => { form.querySelectorAll("input[data-unit], input[data-number]").forEach(slider); grids(); };

  // --- what is done

  form.addEventListener("change", (event) => { if (event.target.dataset.w) commit(event.target); });
  form.addEventListener("keydown", (event) => {
    const input = event.target;
    if (event.ctrlKey && !event.altKey && event.key === "Enter" && input.dataset.w) commit(input);
    if (input.type === "range" || !("unit" in input.dataset || "number" in input.dataset)) {
      if (event.key === "Enter" && input.dataset?.w) commit(input);
      return;
    }
    const sense = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
    if (event.key === "Enter") commit(input);
    if (!sense) return;
    const next = stepped(input, sense);
    if (next === null) return;
    event.preventDefault();
    input.value = next;
    drag(input);
  });
  form.addEventListener("click", (event) => {
    const button = event.target.closest("button");
    if (!button) return;
    const data = button.dataset, field = button.closest(".field")?.querySelector("[data-w]");
    if (button.id === "undo" || button.id === "redo") change({ op: button.id });
    else if ("remedy" in data) { field.value = data.remedy; commit(field); }
    else if ("remove" in data) change({ op: "remove", where: place(field || button) });
    else if ("make" in data) post("make.json", { product: data.make });
    else if ("add" in data) change({ op: "add", where: place(button) });
    else if ("part" in data) change({ op: "add", where: ["parts"], kind: document.getElementById("part").value });
    else if ("up" in data) {
      const where = place(button), index = where.pop();
      change({ op: "move", where, first: index - 1 });
    } else if ("instead" in data) change({ op: "instead", where: place(field), key: data.instead, was: field.dataset.was, value: data.value || "" });
    else if ("goto" in data) {
      const where = JSON.parse(data.goto);
      while (where.length && !byPlace(where)) where.pop();
      const target = byPlace(where);
      for (let node = target?.closest("details"); node; node = node.parentElement.closest("details")) node.open = true;
      (target?.matches("fieldset") ? target.querySelector("[data-w]") : target)?.focus();
    }
  });
  document.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey || event.key.toLowerCase() !== "z" && event.key.toLowerCase() !== "y") return;
    if (event.target.matches("input") && event.target.value !== event.target.dataset.was) return;
    event.preventDefault();
    change({ op: event.key.toLowerCase() === "y" || event.shiftKey ? "redo" : "undo" });
  });

  // --- tables: rows of one length side by side as a grid, with a curve of each over the first

  const MOST_ROWS = 400;
  const values = (input) => (/[\[{"']/.test(input.value) ? [] : input.value.split(",").map((one) => one.trim()).filter(Boolean));
  const node = (name, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(name), properties);
    element.append(...children);
    return element;
  };
  // A single value is changed in its place; a row of another length is written anew.
  const put = (inputs, rows) => inputs.forEach((input, column) => {
    const old = values(input), next = rows.map((row) => row[column]), other = next.flatMap((one, index) => (one === old[index] ? [] : [index]));
    input.value = next.join(", ");
    if (old.length !== next.length || other.length !== 1) { commit(input); return; }
    input.dataset.was = input.value;
    change({ op: "set", where: [...place(input), other[0]], value: next[other[0]], was: old[other[0]] });
  });
  const curve = (columns) => {
    const numbers = columns.map((column) => column.map((one) => parseFloat(one)));
    const [x, ...ys] = numbers, all = ys.flat(), low = Math.min(...all, 0), high = Math.max(...all, low + 1e-9);
    const across = (at) => 4 + 192 * (at - x[0]) / (x[x.length - 1] - x[0] || 1), up = (at) => 76 - 72 * (at - low) / (high - low);
    const lines = ys.map((y) => `M${y.map((at, index) => `${across(x[index])} ${up(at)}`).join("L")}`);
    if (numbers.flat().some((one) => !isFinite(one))) return "";
    const dashes = ["", "5 2", "1.5 1.5", "6 2 1 2"];
    return `<svg viewBox="0 0 200 80" aria-hidden="true"><path d="M4 ${up(0)}H196"/>${lines.map((d, index) => `<path class="curve" stroke-dasharray="${dashes[index % 4]}" d="${d}"/>`).join("")}</svg>`;
  };
  // What is pasted from a workbook: cells by tabs and lines, decimal commas turned, a unit where the column has one.
  const paste = (text, unit) => {
    let turned = false;
    const cells = text.replace(/\r/g, "").replace(/\n+$/, "").split("\n").map((line) => line.split("\t").map((one, column) => {
      let cell = one.trim();
      if (/^[+-]?\d+,\d+(?!\d)/.test(cell)) { cell = cell.replace(",", "."); turned = true; }
      const parts = typed(cell);
      return parts && !parts.over && !parts.unit.trim() && unit(column) ? `${cell} ${unit(column)}` : cell;
    }));
    return { cells, turned };
  };
  const grid = (inputs) => {
    const columns = inputs.map(values), count = columns[0].length;
    const body = columns[0].map((_, row) => node("tr", {}, ...columns.map((column, index) => {
      const cell = node("input", { value: column[row] });
      cell.setAttribute("aria-label", `${inputs[index].labels[0].textContent} ${row + 1}`);
      cell.dataset.row = row;
      cell.dataset.column = index;
      return node("td", {}, cell);
    })));
    const head = node("tr", {}, ...inputs.map((input) => node("th", { scope: "col", textContent: JSON.parse(input.dataset.w).at(-1) })));
    const table = node("table", {}, node("thead", {}, head), node("tbody", {}, ...body));
    const note = node("p", { className: "remark" }), box = node("div", { className: "grid", tabIndex: 0 }, table);
    box.setAttribute("role", "group");
    box.setAttribute("aria-label", words.table);
    const outer = node("details", { className: "tabled" }, node("summary", { textContent: words.table }), box, note);
    outer.dataset.open = `table ${inputs[0].id}`;
    note.insertAdjacentHTML("beforebegin", curve(columns));
    const rows = () => [...table.tBodies[0].rows].map((row) => [...row.querySelectorAll("input")].map((one) => one.value.trim()));
    const go = (row, column) => table.tBodies[0].rows[row]?.querySelectorAll("input")[column]?.focus();
    table.addEventListener("change", () => put(inputs, rows()));
    table.addEventListener("keydown", (event) => {
      const { row, column } = event.target.dataset, move = { ArrowUp: [-1, 0], ArrowDown: [1, 0], Enter: [1, 0] }[event.key];
      const side = event.key === "ArrowLeft" && event.target.selectionStart === 0 ? -1 : event.key === "ArrowRight" && event.target.selectionStart === event.target.value.length ? 1 : 0;
      if (!move && !side) return;
      event.preventDefault();
      event.stopPropagation();
      go(Number(row) + (move ? move[0] : 0), Number(column) + side);
    });
    table.addEventListener("paste", (event) => {
      const text = event.clipboardData.getData("text");
      if (!/[\t\n]/.test(text)) return;
      event.preventDefault();
      const from = Number(event.target.dataset.row), first = Number(event.target.dataset.column);
      const unit = (column) => (typed(columns[first + column]?.[0] || "")?.unit || "").trim();
      const { cells, turned } = paste(text, unit), all = rows();
      cells.forEach((line, index) => {
        all[from + index] ??= columns.map(() => "0");
        line.forEach((one, column) => { if (first + column < columns.length) all[from + index][first + column] = one; });
      });
      const most = Math.min(...inputs.map((input) => Number(input.dataset.list) || Infinity));
      if (all.length > most) {
        const told = words.many_rows.replace("{count}", all.length).replace("{most}", most);
        queue.then(() => { document.getElementById("refused").textContent = told; });
        return;
      }
      put(inputs, all);
      if (turned) queue.then(() => { document.getElementById("refused").textContent = words.commas; });
    });
    inputs[inputs.length - 1].closest(".field").after(outer);
    return count;
  };
  const grids = () => {
    const tables = new Map();
    for (const input of form.querySelectorAll("input[data-list]")) {
      const key = JSON.stringify([JSON.parse(input.dataset.w).slice(0, -1), values(input).length]), length = values(input).length;
      if (length > 2 && length <= MOST_ROWS) tables.set(key, [...(tables.get(key) || []), input]);
    }
    for (const inputs of tables.values()) if (inputs.length > 1) grid(inputs);
  };

  // --- a field and its link: one leads to the other

  const NEAR = 4;
  let owners = { fields: [], ground: {} }, marked = [], following = false;
  const svg = () => machine?.root.querySelector('[data-stage="machine"] svg');
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
    if (!machine) return;
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
  machine?.root.addEventListener("pointermove", (event) => {
    const list = svg()?.contains(event.target) ? under(event) : [];
    const own = new Set(fieldsOf(list).map((one) => one?.closest(".field")));
    form.querySelectorAll(".field.own").forEach((one) => { if (!own.has(one)) one.classList.remove("own"); });
    own.forEach((one) => one?.classList.add("own"));
  });
  machine?.root.addEventListener("click", (event) => {
    if (svg()?.contains(event.target)) fieldsOf(under(event))[0]?.focus();
  });

  // What another tab or an editor has written.
  const tell = (making) => {
    const told = document.getElementById("making");
    if (!making) return;
    told.textContent = `${words.products[making.product]}: ${words.states[making.state]} ${making.step ? words.steps[making.step] : ""} `;
    for (const [name, path] of making.files || []) {
      const link = document.createElement("a");
      link.href = `made/${encodeURIComponent(name)}`;
      link.target = "_blank";
      link.textContent = path;
      told.append(link, " ");
    }
    if (making.complaint) {
      const text = document.createElement("pre");
      text.textContent = making.complaint;
      told.append(text);
    }
    if (making.state === "running") {
      const end = document.createElement("button");
      end.type = "button";
      end.textContent = words.end;
      end.addEventListener("click", () => post("make.json", { end: true }));
      told.append(end);
    }
  };
  document.addEventListener("news", async ({ detail }) => {
    tell(detail.making);
    if (!detail.changed) return;
    await queue;
    const news = await (await fetch("form.json", { cache: "no-store" })).json();
    // What was told of a change of one's own stays until the next one.
    show(news, document.getElementById("refused").childNodes);
    learn();
  });
  // Where there is no room beside the form, the machine stays above it.
  if (matchMedia("(max-width: 61.99rem)").matches && machine) {
    machine.hold(true);
    document.body.classList.add("kept");
  }
  mount();
  learn();
})();
