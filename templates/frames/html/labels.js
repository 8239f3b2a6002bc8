"use strict";
// Where labels of a moving drawing stand, and how large they are: never smaller on the screen than can be read.
// A place costs one for each line through the label, and one for each arrow that is nearer to it than its own, or for
// the name of a point each point.  It costs less where no name has its own best place, and near the middle of the arrow;
// staying where it was is worth something, so that labels do not jump about.
const lettering = (() => {
  const READABLE = 14, STAYS = 0.6, CLEAR = 0.25, TIE = 0.06, DOT = 0.3, WANTED = 0.4;
  // Shares of a vector, turns from the first side of a point, distances from either in heights of letters, each with
  // what it costs.
  const SHARES = [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.1, 0.9, 1, 0, 1.1, -0.1].map((share, rank) => [share, 0.03 * rank]);
  const ASIDE = [[0.3, 0], [0.75, 0.3], [1.4, 0.6]], FURTHER = [[0, 0], [0.4, 0.4], [1, 1], [1.8, 2], [2.8, 4]];
  const ABOUT = [0, 1, -1, 2, -2, 3, -3, 4].map((eighth) => [eighth * Math.PI / 4, 0.02 * Math.abs(eighth)]);

  // A line is its middle and half of its way, with the item of its arrow if it is one.
  const line = (stage, x1, y1, x2, y2, item = null) => {
    const one = [(x1 + x2) / 2, (y1 + y2) / 2, (x2 - x1) / 2, (y2 - y1) / 2, item];
    stage.lines.push(one);
    return one;
  };
  // Whether a line runs through the box of half the size (w, h) at (x, y).
  const runsThrough = ([mx, my, hx, hy], x, y, w, h) => {
    const dx = Math.abs(mx - x), dy = Math.abs(my - y);
    return dx < Math.abs(hx) + w && dy < Math.abs(hy) + h &&
      Math.abs((mx - x) * hy - (my - y) * hx) < w * Math.abs(hy) + h * Math.abs(hx);
  };
  const aside = (dx, dy, w, h) => Math.hypot(Math.max(Math.abs(dx) - w, 0), Math.max(Math.abs(dy) - h, 0));
  // The distance of a line from that box; any that is not below `most` may be too small by what does not matter.
  const away = (one, x, y, w, h, most) => {
    const mx = one[0] - x, my = one[1] - y, hx = one[2], hy = one[3];
    if (Math.abs(mx) - Math.abs(hx) - w >= most || Math.abs(my) - Math.abs(hy) - h >= most) return most;
    if (runsThrough(one, x, y, w, h)) return 0;
    let least = Math.min(aside(mx + hx, my + hy, w, h), aside(mx - hx, my - hy, w, h));
    const square = hx * hx + hy * hy;
    for (const cx of [-w, w]) {
      for (const cy of [-h, h]) {
        const along = Math.min(Math.max(((cx - mx) * hx + (cy - my) * hy) / square, -1), 1);
        least = Math.min(least, Math.hypot(cx - mx - along * hx, cy - my - along * hy));
      }
    }
    return least;
  };

  const offPoint = ([px, py], x, y, w, h) => aside(px - x, py - y, w, h);
  const overlap = ([a, b, c, d], x, y, w, h) => Math.abs(x - a) < w + c && Math.abs(y - b) < h + d;

  // The order in which labels choose: those of short arrows first, as they have few places.  On the machine the names of
  // points are what one looks for and come before all.
  const ordered = (stage, namesFirst) => {
    const rank = ({ own }) => own.length > 2 ? Math.hypot(own[2], own[3]) : namesFirst ? -1 : Infinity;
    return stage.labels.map((label) => [rank(label), label]).sort(([a], [b]) => a - b || 0).map(([, label]) => label);
  };

  // The number of the place of a label: -1 where it would cover another, or be cut off, wherever it stood.
  const choose = (stage, names, { places, w, h, item, own }) => {
    const [left, top, right, bottom] = stage.room, ofArrow = own.length > 2;
    const rivals = ofArrow ? stage.lines.filter((one) => one[4]) : stage.points, off = ofArrow ? away : offPoint;
    let least = Infinity, number = -1;
    const attempt = (index, rank) => {
      if (rank >= least) return;
      const [x, y] = places[index];
      if (x - w < left || x + w > right || y - h < top || y + h > bottom) return;
      if (names.some((one) => overlap(one, x, y, w + CLEAR, h + CLEAR))) return;
      let cost = rank;
      for (const one of stage.lines) if (runsThrough(one, x, y, w, h) && (cost += 1) >= least) return;
      for (const one of stage.wanted) if (one[4] !== item && overlap(one, x, y, w, h)) cost += WANTED;
      const near = off(own, x, y, w, h, Infinity) - TIE;
      for (const one of rivals) if (one !== own && off(one, x, y, w, h, near) < near && (cost += 1) >= least) return;
      if (cost < least) { least = cost; number = index; }
    };
    if (item.last >= 0) attempt(item.last, places[item.last][2] - STAYS);
    for (let index = 0; index < places.length; index += 1) attempt(index, places[index][2]);
    if (number >= 0) names.push([places[number][0], places[number][1], w, h]);
    return number;
  };

  // The number of the place of each label.
  const place = (stage, namesFirst) => {
    const names = stage.names.slice();
    return ordered(stage, namesFirst).map((label) => [label, choose(stage, names, label)]);
  };

  // Places beside a vector: at its middle or elsewhere along it, on either side, close to it or a little off.
  const beside = (x1, y1, dx, dy, w, h, em) => {
    const length = Math.hypot(dx, dy), ux = dx / length, uy = dy / length;
    return ASIDE.flatMap(([gap, further]) => SHARES.flatMap(([share, cost]) => [1, -1].map((side) => {
      const off = side * (Math.abs(uy) * w + Math.abs(ux) * h + gap * em);
      return [x1 + dx * share + uy * off, y1 + dy * share - ux * off, cost + further];
    })));
  };
  // Places about a point, first in one direction (rad).
  const about = (x, y, first, w, h, gap, em) => FURTHER.flatMap(([further, beyond]) => ABOUT.map(([turn, cost]) => {
    const a = Math.cos(first + turn), b = Math.sin(first + turn), off = gap + further * em + Math.min(w / Math.abs(a), h / Math.abs(b));
    return [x + a * off, y + b * off, cost + beyond];
  }));

  // The size of a label: half its width and height as the report's letters have it, or the reader's if they are wider,
  // and its letters, all of them larger where the drawing is shown so small that they could not be read.
  const sized = (element, [w, h, em]) => {
    const text = element.querySelector("text"), wide = Math.max(w, text ? text.getComputedTextLength() / 2 : 0);
    // An index below an exponent begins with it, whatever letters the reader's font has.
    for (const run of element.querySelectorAll("tspan[dx]")) {
      const first = run.previousElementSibling;
      run.setAttribute("dx", `${-first.getComputedTextLength() / parseFloat(getComputedStyle(first).fontSize)}em`);
    }
    return (stage) => {
      const larger = enlarged(stage, em);
      return { w: wide * larger, h: h * larger, em: em * larger, scale: larger === 1 ? "" : ` scale(${Math.round(larger * 1000) / 1000})` };
    };
  };
  const enlarged = (stage, em) => stage.pixels ? Math.max(READABLE / (em * stage.pixels), 1) : 1;

  // What a millimetre of each drawing has on the screen (px), with the numbers of its bars in their size; whether any
  // has changed.  All are measured before the first is changed.
  const measure = (stages) => {
    const changed = stages.filter((stage) => {
      const svg = stage.element.querySelector("svg"), { width, height } = svg.getBoundingClientRect(), box = svg.viewBox.baseVal;
      const before = stage.pixels;
      stage.pixels = Math.min(width / box.width, height / box.height);
      return Math.abs(stage.pixels - before) > 1e-6;
    });
    const numbers = changed.flatMap((stage) => [...stage.element.querySelectorAll("[data-bar] text")].map((text) => [
      text, Number(text.getAttribute("x")), Number(text.getAttribute("y")), enlarged(stage, parseFloat(getComputedStyle(text).fontSize))]));
    for (const [text, x, y, larger] of numbers) text.setAttribute("transform", `translate(${x} ${y}) scale(${larger}) translate(${-x} ${-y})`);
    return changed.length > 0;
  };
  return { DOT, line, place, beside, about, sized, measure };
})();
