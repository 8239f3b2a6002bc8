"use strict";
// What moves, a panel each.  Nothing is computed here but straight lines between two samples of the solver:
// a track is an array over the samples, an item names the tracks that it follows.
const panelOf = (root, panels) => {
  const TURN_SECONDS = 7, ARROW_SHARE = 0.75, SHORT = 3, NOTHING = 0.02, READABLE = 120, SLOW = 22;
  // What a panel has by an id begins with its own name, as the panel itself; that of the machine has none.
  const own = root.id.slice(0, -"moving".length), byId = (name) => root.querySelector(`#${own}${name}`);
  // `run` is the motion that is played as the time goes, `clock` its time (s); null at constant speed.  `partly` is true
  // while only what is in sight has its samples.
  const state = { angle: 0, playing: false, last: 0, rate: 1, told: 0, pace: 16, run: null, clock: 0, partly: false };
  let animation, steps, values, starts, drawing, now;

  // --- samples

  const unpack = (text) => {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    return new Float32Array(bytes.buffer);
  };

  // Of single instants `steps` has what is told of each and where the driver stands; at all other times nothing is known.
  const STEP = 1500;
  const nearest = (angle) => animation.positions.reduce((best, [, at], index) =>
    Math.abs(at - angle) < Math.abs(animation.positions[best][1] - angle) ? index : best, 0);

  // What a run has where one of its samples, which grow, comes to a value.
  const within = (run, by, at) => {
    const grown = run[by];
    let low = 0, high = grown.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (grown[middle] <= at) low = middle; else high = middle;
    }
    const share = Math.min(Math.max((at - grown[low]) / (grown[high] - grown[low] || 1), 0), 1);
    const between = (name) => run[name][low] + share * (run[name][high] - run[name][low]);
    return { angle: between("angle"), time: between("time"), speed: between("speed"), drive: between("drive") };
  };
  const running = () => state.run ? within(state.run, "time", state.clock) : within(animation.runs[0], "angle", state.angle);
  const lasts = (run) => run.time[run.time.length - 1];
  // So much slower than in truth a steady cycle takes as long as one at constant speed.
  const slower = () => lasts(animation.runs[0]) / (TURN_SECONDS * animation.turns);

  // The sample before an angle (degrees), of the turn and of the cycle, and how far on to the next it is.
  const place = (angle) => {
    const knots = animation.knots, last = knots.length - 1;
    const turn = Math.min(Math.floor(angle / 360), animation.turns - 1), local = angle - 360 * turn;
    let low = 0, high = last;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (knots[middle] <= local) low = middle; else high = middle;
    }
    const share = Math.min(Math.max((local - knots[low]) / (knots[high] - knots[low]), 0), 1);
    return { turn: low, cycle: turn * last + low, share, ofTurn: last + 1 };
  };

  const value = (track) => {
    const length = animation.lengths[track], start = starts[track];
    if (length === 1) return values[start];
    const index = start + (length === now.ofTurn ? now.turn : now.cycle), one = values[index];
    return now.share === 0 ? one : one + now.share * (values[index + 1] - one);
  };

  // A drawing that is small at the moment is shown at a finer scale, that of the sample nearest by.
  const rescale = (part) => {
    const finer = animation.finer[part.element.dataset.stage];
    if (!finer) return;
    const index = sample(finer.at, now.cycle + (now.share > 0.5 ? 1 : 0));
    part.zoom = finer.times[index];
    part.bars.forEach((one, number) => one.toggleAttribute("hidden", number !== index));
  };

  const sample = (track, index) => values[starts[track] + (animation.lengths[track] === 1 ? 0 : index)];

  // --- drawing

  const short = (number) => Math.round(number * 1000) / 1000;
  const hidden = new WeakSet();
  const show = (element, shown) => {
    if (shown !== hidden.has(element)) return;
    if (shown) {
      hidden.delete(element);
      element.removeAttribute("display");
    } else {
      hidden.add(element);
      element.setAttribute("display", "none");
    }
  };

  const carried = (element, item, stage) => () => {
    const x = stage.zoom * value(item.at), y = -stage.zoom * value(item.at + 1), there = isFinite(x + y);
    show(element, there);
    if (!there) return;
    const turn = item.turn === undefined ? "" : ` rotate(${short(-value(item.turn) * 180 / Math.PI)})`;
    element.setAttribute("transform", `translate(${short(x)} ${short(y)})${turn}`);
  };

  // --- labels

  // Where a label has no place it is left out.  While the machine moves, a label that takes another place glides there.
  const GLIDE = 0.8;
  const settle = (label, number) => {
    const { element, item, size } = label, before = item.last;
    item.last = number;
    show(element, number >= 0);
    if (number < 0) return;
    const [x, y] = label.places[number];
    if (!state.playing || !(before >= 0)) item.lag = null;
    else if (item.last !== before) item.lag = [label.places[before][0] + (item.lag?.[0] ?? 0) - x, label.places[before][1] + (item.lag?.[1] ?? 0) - y];
    else if (item.lag) item.lag = item.lag.map((one) => GLIDE * one);
    const [dx, dy] = item.lag || [0, 0];
    element.setAttribute("transform", `translate(${short(x + dx)} ${short(y + dy)})${size.scale}`);
  };

  const vector = (element, item, stage) => {
    const [shaft, ...others] = element.children;
    const head = item.head ? others[0] : null, label = item.size ? others[others.length - 1] : null;
    const sized = label && lettering.sized(label, item.size);
    return () => {
      const z = stage.zoom;
      const x1 = z * value(item.from), y1 = -z * value(item.from + 1), x2 = z * value(item.to), y2 = -z * value(item.to + 1);
      const dx = x2 - x1, dy = y2 - y1, length = Math.hypot(dx, dy), there = length > NOTHING;
      show(element, there);
      if (!there) return;
      const ux = dx / length, uy = dy / length;
      let end = length + (item.beyond || 0);
      if (head) {
        const size = Math.min(item.head, ARROW_SHARE * length), side = 0.5 * item.slender * size;
        const bx = x2 - ux * size, by = y2 - uy * size;
        head.setAttribute("d", `M${short(x2)} ${short(y2)}L${short(bx - uy * side)} ${short(by + ux * side)}` +
          `L${short(bx + uy * side)} ${short(by - ux * side)}Z`);
        end = length - 0.7 * size;
      }
      shaft.setAttribute("d", `M${short(x1)} ${short(y1)}L${short(x1 + ux * end)} ${short(y1 + uy * end)}`);
      const own = lettering.line(stage, x1, y1, x2, y2, head && item);
      if (!label) return;
      show(label, length > SHORT);
      if (length <= SHORT) return;
      const size = sized(stage), { w, h } = size;
      stage.labels.push({ element: label, places: lettering.beside(x1, y1, dx, dy, w, h, size.em), w, h, item, own, size });
    };
  };

  // A name stands on the side away from what its point is joined to, or elsewhere about it.
  const name = (element, item, stage) => {
    const sized = lettering.sized(element, item.size), { DOT, line } = lettering;
    return () => {
      const z = stage.zoom, x = z * value(item.label), y = -z * value(item.label + 1), there = isFinite(x + y);
      if (!there) { show(element, false); return; }
      let ux = 0, uy = 0, px = 0, py = 0;
      for (const other of item.off) {
        const dx = x - z * value(other), dy = y + z * value(other + 1), length = Math.hypot(dx, dy);
        if (length > 0.5) { ux += dx / length; uy += dy / length; px = -dy / length; py = dx / length; line(stage, x, y, x - dx, y - dy); }
      }
      if (Math.hypot(ux, uy) < 0.35) { ux += px || 0.8; uy += py || -0.6; }
      const size = sized(stage), { w, h } = size, own = [x, y];
      stage.names.push([x, y, DOT, DOT]);
      stage.points.push(own);
      const places = lettering.about(x, y, Math.atan2(uy, ux), w, h, item.gap, size.em);
      const [a, b] = places[item.last > 0 ? item.last : 0];
      stage.wanted.push([a, b, w, h, item]);
      stage.labels.push({ element, places, w, h, item, own, size });
    };
  };

  const follower = (element, stage) => {
    const item = animation.items[element.dataset.i];
    if (item.from !== undefined) return vector(element, item, stage);
    return item.label === undefined ? carried(element, item, stage) : name(element, item, stage);
  };

  const written = (number, decimals) => {
    if (!isFinite(number)) return "–";
    let text = number.toFixed(decimals);
    if (Number(text) === 0) text = text.replace("-", "");
    text = text.replace("-", "−");
    return text.replace(".", animation.decimal);
  };

  // Another text in the same node: nothing is put in or taken out.
  const say = (element, text) => {
    if (!element.firstChild) element.append(text); else if (element.firstChild.data !== text) element.firstChild.data = text;
  };

  const decimalsFor = (greatest) => Math.min(Math.max(4 - Math.floor(Math.log10(greatest || 1)), 0), 5);

  const chart = (element) => {
    const about = animation.charts[element.dataset.chart], [left, bottom, right, top] = about.box;
    const cursor = element.querySelector(".cursor"), dots = element.querySelectorAll(".dot");
    const outputs = element.querySelectorAll("output"), width = about.x[1] - about.x[0];
    const oneTurn = !animation.span && width < 360 * animation.turns - 1;
    const decimals = decimalsFor(Math.max(...about.y.map(Math.abs)));
    const svg = element.querySelector(".over");
    svg.addEventListener("pointerdown", (event) => {
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      const x = about.x[0] + (at.x - left) / (right - left) * width;
      pause();
      if (about.run) return;
      seek(animation.span ? x / animation.span * 360 : x + (oneTurn ? 360 * Math.floor(state.angle / 360) : 0));
    });
    if (about.run) {
      return (readable) => {
        const at = running();
        const x = left + (at.speed - about.x[0]) / width * (right - left);
        const y = bottom + (at.drive - about.y[0]) / (about.y[1] - about.y[0]) * (top - bottom);
        cursor.setAttribute("d", `M${short(x)} ${bottom}V${top}`);
        dots[0].setAttribute("transform", `translate(${short(x)} ${short(y)})`);
        if (readable) say(outputs[0], written(at.drive, decimals));
      };
    }
    return (readable) => {
      const along = animation.span ? state.angle / 360 * animation.span : oneTurn ? state.angle % 360 : state.angle;
      const x = short(left + (along - about.x[0]) / width * (right - left));
      cursor.setAttribute("d", `M${x} ${bottom}V${top}`);
      about.curves.forEach((track, index) => {
        const here = value(track), y = bottom + (here - about.y[0]) / (about.y[1] - about.y[0]) * (top - bottom);
        dots[index].setAttribute("transform", `translate(${x} ${short(y)})`);
        if (readable) say(outputs[index], written(here, decimals));
      });
    };
  };

  // --- the moment shown

  // Only what is on the screen is drawn; the rest when it comes there.  A folded panel is not on the screen.
  const seen = new WeakSet();
  const watcher = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) if (isIntersecting) seen.add(target); else seen.delete(target);
    if (now) draw();
  }, { rootMargin: "100px" });
  const visible = (element) => !state.playing && !state.partly || seen.has(element);

  const sizes = new ResizeObserver(() => {
    if (lettering.measure(drawing.parts) && now) draw();
  });

  const draw = () => {
    now = place(state.angle);
    const time = performance.now(), readable = !state.playing || time - state.told > READABLE;
    drawing.count += 1;
    const turns = state.playing && state.pace > SLOW ? Math.min(Math.round(state.pace / 10), 4) : 1;
    for (const [index, part] of drawing.parts.entries()) {
      if (!visible(part.element)) continue;
      // Where frames take long the machine goes on smoothly, and plans follow in turns.
      if (index && (index + drawing.count) % turns) continue;
      part.names = [];
      part.labels = [];
      part.lines = [];
      part.points = [];
      part.wanted = [];
      rescale(part);
      for (const { update, layer } of part.followers) if (!layer || drawing.layers[layer]) update();
      for (const [label, number] of lettering.place(part, !index)) settle(label, number);
    }
    // Figures that change faster than this cannot be read.
    if (readable && visible(drawing.numbers)) {
      drawing.outputs.forEach((output, index) => {
        const [track, decimals] = animation.values[index];
        say(output, written(value(track), decimals));
      });
    }
    for (const { element, update } of drawing.charts) if (visible(element)) update(readable);
    if (readable) {
      state.told = time;
      tell();
    }
    const at = state.run && running();
    const timed = at ? ` · ${animation.words.run_told.replace("{t}", written(at.time, 3)).replace("{w}", written(at.speed, 2))}` : "";
    const told = timed ? `${written(at.angle, 1)}°${timed}` : steps ? steps[nearest(state.angle)][0] : animation.span ? `${written(state.angle / 360 * animation.span, 1)} mm` : `${written(state.angle, 1)}°`;
    if (!state.playing || drawing.count % 3 === 0) drawing.slider.value = state.angle;
    if (readable) {
      say(drawing.told, told);
      drawing.slider.setAttribute("aria-valuetext", told);
    }
    const near = animation.positions.findIndex(([, at]) => Math.abs(at - state.angle) < 1e-4);
    if (near !== drawing.near) {
      drawing.near = near;
      drawing.buttons.forEach((button, index) => {
        if (index === near) button.setAttribute("aria-current", "true"); else button.removeAttribute("aria-current");
      });
    }
  };

  const choose = (index) => {
    state.run = index === "" ? null : animation.runs[index];
    state.clock = 0;
    if (byId("run")) byId("run").value = index;
  };
  const turned = (angle) => {
    const whole = 360 * animation.turns;
    return ((angle % whole) + whole) % whole;
  };

  // Who goes to a place leaves the motion in time, but for the steady one, which is at each place once.
  const seek = (angle) => {
    const whole = 360 * animation.turns;
    if (state.run && state.run === animation.runs[0]) state.clock = within(state.run, "angle", turned(angle)).time;
    else if (state.run) choose("");
    if (steps) angle = animation.positions[nearest(angle)][1];
    state.angle = animation.span ? Math.min(Math.max(angle, 0), whole) : ((angle % whole) + whole) % whole;
    draw();
  };

  const frame = (time) => {
    if (!state.playing) return;
    if (steps) {
      if (time - state.last >= STEP / state.rate) {
        state.last = time;
        seek(animation.positions[(nearest(state.angle) + 1) % steps.length][1]);
      }
      requestAnimationFrame(frame);
      return;
    }
    const passed = Math.min(time - state.last, 100) / 1000;
    state.pace += (time - state.last - state.pace) / 8;
    state.last = time;
    if (state.run) {
      const end = lasts(state.run), next = state.clock + passed * state.rate * slower();
      state.clock = state.run === animation.runs[0] ? next % end : Math.min(next, end);
      state.angle = turned(running().angle);
      if (visible(root)) draw();
      if (state.clock >= end) { pause(); return; }
      requestAnimationFrame(frame);
      return;
    }
    const whole = 360 * animation.turns, next = state.angle + passed * state.rate * 360 / TURN_SECONDS;
    state.angle = next >= whole ? next % whole : next;
    // A panel that is not on the screen goes on unseen.
    if (visible(root)) draw();
    requestAnimationFrame(frame);
  };

  const mark = () => {
    drawing.play.textContent = state.playing ? animation.words.pause : animation.words.play;
  };
  const play = () => {
    if (state.playing) return;
    state.playing = true;
    // A start or a stop that is over begins anew.
    if (state.run && state.clock >= lasts(state.run)) state.clock = 0;
    state.last = performance.now();
    mark();
    requestAnimationFrame(frame);
  };
  const pause = () => { state.playing = false; mark(); draw(); };

  // The next numbered position on either side.
  const step = (sense) => {
    const at = animation.positions.map(([, angle]) => angle);
    const on = sense > 0 ? at.find((angle) => angle > state.angle + 1e-3) : at.findLast((angle) => angle < state.angle - 1e-3);
    pause();
    seek(on === undefined ? at[sense > 0 ? 0 : at.length - 1] : on);
  };

  const move = (sense) => steps ? step(sense) : seek(Math.round(state.angle) + sense);
  const keys = {
    ArrowRight: () => move(1), ArrowUp: () => move(1), ArrowLeft: () => move(-1), ArrowDown: () => move(-1),
    PageUp: () => step(1), PageDown: () => step(-1), Home: () => seek(0), End: () => seek(360 * animation.turns - 1e-6),
  };
  const key = (event) => {
    if (!keys[event.key] || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    if (event.key.startsWith("Arrow")) pause();
    keys[event.key]();
  };

  // --- one point: its motion now, its values over the turn

  const told = () => {
    const index = drawing.pointed ?? (drawing.point.value === "" ? null : Number(drawing.point.value));
    return index === null ? null : animation.spots[index];
  };
  const tell = () => {
    const spot = told();
    drawing.motion.hidden = drawing.tools.hidden = !spot;
    if (!spot) return;
    for (const rate of ["v", "a"]) {
      const size = Math.hypot(value(spot[rate]), value(spot[rate] + 1));
      say(drawing.rates[rate], written(size, decimalsFor(size)));
    }
  };
  const table = (spot, between) => {
    const rows = [animation.heads.join(between)];
    animation.knots.forEach((knot, index) => {
      if (steps && index >= steps.length) return;
      const [x, y, vx, vy, ax, ay] = ["p", "v", "a"].flatMap((what) => [sample(spot[what], index), sample(spot[what] + 1, index)]);
      const driver = steps ? steps[index][1] : animation.span ? knot / 360 * animation.span : knot;
      const row = [driver, x, y, vx, vy, Math.hypot(vx, vy), ax, ay, Math.hypot(ax, ay)];
      rows.push(row.map((number) => isFinite(number) ? String(Number(number.toPrecision(7))) : "").join(between));
    });
    return rows.join("\r\n") + "\r\n";
  };
  const copy = async () => {
    const text = table(told(), "\t");
    try {
      await navigator.clipboard.writeText(text);
    } catch {
      const area = document.createElement("textarea");
      area.value = text;
      root.append(area);
      area.select();
      document.execCommand("copy");
      area.remove();
    }
    drawing.copied.textContent = animation.words.copied;
    setTimeout(() => { drawing.copied.textContent = ""; }, 2000);
  };
  const save = () => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob(["\ufeff" + table(told(), ",")], { type: "text/csv" }));
    link.download = `${told().name}.csv`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };

  // Kept in view while one reads; one panel at a time is.
  const hold = (on) => {
    root.classList.toggle("held", on);
    drawing.keep.textContent = on ? animation.words.release : animation.words.keep;
  };

  // --- setting up, and anew when the page is renewed

  const mount = (data) => {
    state.partly = false;
    animation = data;
    steps = animation.instants;
    values = unpack(animation.tracks);
    starts = [];
    animation.lengths.reduce((start, length) => { starts.push(start); return start + length; }, 0);
    const find = (query) => root.querySelector(query), all = (query) => [...root.querySelectorAll(query)];
    drawing = {
      layers: {}, near: -1, count: 0, slider: byId("angle"), told: byId("told"), play: byId("play"), numbers: find(".numbers"),
      outputs: all("[data-value]"), buttons: all("[data-position]"), point: byId("point"), motion: byId("motion"),
      tools: byId("tools"), copied: byId("copied"), keep: byId("keep"), pointed: null,
      rates: { v: find('[data-of="v"]'), a: find('[data-of="a"]') },
    };
    drawing.parts = all("[data-stage]").map((element) => {
      const part = { element, names: [], labels: [], lines: [], points: [], wanted: [], pixels: 0, followers: [], zoom: 1, bars: [...element.querySelectorAll("[data-scale]")] };
      part.room = element.querySelector("svg").dataset.room.split(" ").map(Number);
      part.followers = [...element.querySelectorAll("[data-i]")].map((one) => (
        { element: one, update: follower(one, part), layer: one.dataset.ofLayer }));
      element.querySelectorAll(".spot").forEach((one) => {
        const spot = animation.spots[one.dataset.spot];
        part.followers.push({ element: one, update: carried(one, { at: spot.at }, part) });
        const point = (index) => () => { drawing.pointed = index; tell(); };
        one.addEventListener("pointerenter", point(Number(one.dataset.spot)));
        one.addEventListener("pointerleave", point(null));
        one.addEventListener("focus", point(Number(one.dataset.spot)));
        one.addEventListener("blur", point(null));
        const choose = () => { drawing.point.value = one.dataset.spot; tell(); };
        one.addEventListener("click", choose);
        one.addEventListener("keydown", (event) => {
          if (event.key === "Enter" || event.key === " ") { event.preventDefault(); choose(); } else key(event);
        });
      });
      return part;
    });
    drawing.charts = all("[data-chart]").map((element) => ({ element, update: chart(element) }));
    all("[data-layer]").forEach((box) => {
      const layer = box.dataset.layer;
      const switched = () => {
        drawing.layers[layer] = box.checked;
        all(`[data-of-layer~="${layer}"]`).forEach((element) => (
          element.toggleAttribute("hidden", !element.dataset.ofLayer.split(" ").some((one) => drawing.layers[one]))));
        if (now) draw();
      };
      box.addEventListener("change", switched);
      switched();
    });
    drawing.play.addEventListener("click", () => (state.playing ? pause() : play()));
    drawing.slider.addEventListener("input", () => { pause(); seek(Number(drawing.slider.value)); });
    drawing.slider.addEventListener("keydown", key);
    drawing.point.addEventListener("change", tell);
    byId("speed").addEventListener("change", (event) => { state.rate = Number(event.target.value); });
    byId("run")?.addEventListener("change", (event) => {
      choose(event.target.value);
      if (state.run) state.angle = turned(running().angle);
      draw();
    });
    byId("copy").addEventListener("click", copy);
    byId("save").addEventListener("click", save);
    drawing.buttons.forEach((button, index) => button.addEventListener("click", () => {
      pause();
      seek(animation.positions[index][1]);
    }));
    drawing.keep.addEventListener("click", () => {
      const on = !root.classList.contains("held");
      for (const panel of panels) panel.hold(on && panel.root === root);
      document.body.classList.toggle("kept", on);
    });
    hold(root.classList.contains("held"));
    watcher.disconnect();
    sizes.disconnect();
    lettering.measure(drawing.parts);
    for (const part of drawing.parts) sizes.observe(part.element.querySelector("svg"));
    for (const element of [root, drawing.numbers, ...all("[data-stage], [data-chart]")]) watcher.observe(element);
    choose("");
    mark();
  };

  // What a reader has chosen stays when the machine changes: angle, open panels, layers, point, speed.  What has not
  // changed is left as it is.
  const renew = (body, samples) => {
    if (body === shown.body && samples === shown.samples) return;
    shown = { body, samples };
    const open = Object.fromEntries([...root.querySelectorAll("[data-panel]")].map((one) => [one.dataset.panel, one.open]));
    const layers = { ...drawing.layers }, chosen = told()?.name, rate = byId("speed").value;
    const focused = root.contains(document.activeElement) ? document.activeElement.id : "";
    root.innerHTML = body;
    for (const one of root.querySelectorAll("[data-panel]")) {
      if (one.dataset.panel in open) one.open = open[one.dataset.panel];
    }
    for (const box of root.querySelectorAll("[data-layer]")) box.checked = layers[box.dataset.layer] ?? box.checked;
    byId("speed").value = rate;
    now = undefined;
    mount(JSON.parse(samples));
    const index = animation.spots.findIndex((spot) => spot.name === chosen);
    drawing.point.value = index < 0 ? "" : String(index);
    if (focused) document.getElementById(focused)?.focus();
    seek(state.angle);
  };

  let shown = { samples: document.getElementById(`${own}samples`).textContent };
  mount(JSON.parse(shown.samples));
  const start = () => {
    seek(animation.positions[animation.shown][1]);
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) play();
  };
  return { root, own, start, hold, seek, play, pause, renew, angle: () => state.angle, playing: () => state.playing };
};
const panels = [];
for (const root of document.querySelectorAll(".moving")) panels.push(panelOf(root, panels));
// All are measured before the first is drawn: what is drawn would have the page laid out anew for the next.
for (const panel of panels) panel.start();
// That of the machine.
const [moving] = panels;
