"use strict";
// A handle turns the machine: a ring about the crank, or a line beside a sliding driver.  Arrow keys turn it, too.
(() => {
  const panel = typeof panels === "undefined" ? undefined : panels[0];
  if (!panel || !pulls) return;
  const BESIDE = 2.5, WIDE = 5, FINGER = 24, KNOB = 2.2;
  const words = JSON.parse(document.getElementById("live").textContent).words;
  let driver = null, turning = null;

  const { svg, toDrawing, element } = pulls;
  const own = () => extended.get(panel.root);
  const whole = (angle) => angle - 360 * Math.round(angle / 360);
  // Where a place is seen from the centre, in degrees, anticlockwise.
  const seen = ([x, y]) => {
    const [cx, cy] = pulls.at(driver.centre);
    return Math.atan2(cy - y, x - cx) * 180 / Math.PI;
  };
  const wide = () => Math.max(WIDE, FINGER / svg().getScreenCTM().a / 1.5);

  const draw = (found) => {
    svg().querySelector(".handle")?.remove();
    driver = found;
    if (!driver || !own().spotAt(driver.pin)) return;
    const handle = element("g", { class: "handle", tabindex: 0, role: "slider", "aria-label": words.handle, "aria-valuemin": 0, "aria-valuemax": 360 });
    // The ring goes past what is chosen and pulled at the pin.
    const off = Number(svg().querySelector(".spot circle").getAttribute("r")) + BESIDE;
    const band = wide(), track = element("path", { class: "track" }), hit = element("path", { class: "hit", "stroke-width": band });
    const knob = element("circle", { r: KNOB });
    handle.append(track, hit, knob);
    svg().insertBefore(handle, svg().querySelector(".spot"));
    const places = own().way(driver.pin), [, first] = places[0], [, last] = places[places.length - 1];
    const [dx, dy] = [last[0] - first[0], last[1] - first[1]], length = Math.hypot(dx, dy) || 1;
    const across = [-dy / length * off, dx / length * off];
    own().follow(handle, (angle, tell) => {
      const [x, y] = own().spotAt(driver.pin);
      let way, place;
      if (driver.centre) {
        const [cx, cy] = pulls.at(driver.centre), radius = Math.hypot(x - cx, y - cy), outer = radius + off;
        place = [cx + (x - cx) * outer / radius, cy + (y - cy) * outer / radius];
        way = `M${cx + outer} ${cy}a${outer} ${outer} 0 1 0 ${-2 * outer} 0a${outer} ${outer} 0 1 0 ${2 * outer} 0`;
      } else {
        place = [x + across[0], y + across[1]];
        way = `M${first[0] + across[0]} ${first[1] + across[1]}L${last[0] + across[0]} ${last[1] + across[1]}`;
      }
      for (const path of [track, hit]) if (path.getAttribute("d") !== way) path.setAttribute("d", way);
      knob.setAttribute("cx", place[0]);
      knob.setAttribute("cy", place[1]);
      handle.setAttribute("aria-valuenow", Math.round(angle % 360));
      // It is told after all is drawn.
      queueMicrotask(() => handle.setAttribute("aria-valuetext", tell()));
    });
  };

  // The cycle angle at which the driver is where the pointer is.
  const angleAt = (place) => {
    if (driver.centre && !driver.instants) {
      const next = seen(place);
      turning.angle += driver.turn * whole(next - turning.seen);
      turning.seen = next;
      return turning.angle;
    }
    const places = own().way(driver.pin), off = ([, [x, y]]) => Math.hypot(x - place[0] - turning.off[0], y - place[1] - turning.off[1]);
    return places.slice(0, driver.instants ? -1 : undefined).reduce((best, one) => (off(one) < off(best) ? one : best))[0];
  };
  const stop = () => {
    turning = null;
    document.body.classList.remove("turning");
  };
  panel.root.addEventListener("pointerdown", (event) => {
    if (event.button || turning || !event.target.closest?.(".handle")) return;
    panel.pause();
    const place = toDrawing(event), [x, y] = own().spotAt(driver.pin);
    turning = { id: event.pointerId, angle: panel.angle(), from: panel.angle(), seen: driver.centre ? seen(place) : 0, off: [x - place[0], y - place[1]] };
    panel.root.setPointerCapture(event.pointerId);
    document.body.classList.add("turning");
    event.target.closest(".handle").focus({ preventScroll: true });
    event.preventDefault();
  });
  panel.root.addEventListener("pointermove", (event) => {
    if (turning && event.pointerId === turning.id) panel.seek(angleAt(toDrawing(event)));
  });
  const back = () => {
    const { from } = turning;
    stop();
    panel.seek(from);
  };
  addEventListener("pointerup", (event) => { if (turning?.id === event.pointerId) { stop(); pulls.noClick(); } });
  addEventListener("pointercancel", (event) => { if (turning?.id === event.pointerId) back(); });
  addEventListener("pointerdown", (event) => { if (turning && turning.id !== event.pointerId) back(); }, true);
  addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !turning) return;
    event.stopPropagation();
    back();
  }, true);
  panel.root.addEventListener("touchstart", (event) => {
    if (event.changedTouches[0].target.closest?.(".handle")) event.preventDefault();
  }, { passive: false });
  document.addEventListener("gripped", ({ detail }) => draw(detail.driver));
})();
