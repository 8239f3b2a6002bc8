  // Put into each panel where a form stands beside it: other samples of the same machine while a value is drawn, bodies
  // in their new shape, and where a point is on the drawing.
  const reshaped = new Map();
  let mounted, fed;
  extended.set(root, {
    // What is in sight: the names of drawings, and of the layers that are shown; null if numbers or curves are, too.
    sight: () => {
      const stages = drawing.parts.map((part) => part.element).filter((one, index) => !index || seen.has(one));
      const layers = Object.keys(drawing.layers).filter((layer) => drawing.layers[layer]);
      if (seen.has(drawing.numbers) || drawing.charts.some(({ element }) => seen.has(element))) return null;
      return [...stages.map((one) => one.dataset.stage), ...layers];
    },
    // Samples stand in runs, [place, number] each, among those of the machine as it was mounted.  Of a part of them only
    // what is in sight is drawn.
    feed: (samples, { bodies, runs }, part = false) => {
      if (values !== fed) mounted = values;
      fed = values = mounted.slice();
      let taken = 0;
      for (const [place, number] of runs) values.set(samples.subarray(taken, taken += number), place);
      shown = {};
      // What stands beneath the machine is not its own.
      const items = [...drawing.parts[0].element.querySelector("svg").children].filter((one) => !one.matches(".beneath"));
      const next = new Map(Object.entries(bodies).map(([place, body]) => [items[place], body]));
      for (const [item, body] of reshaped) if (!next.has(item)) { item.innerHTML = body; reshaped.delete(item); }
      for (const [item, body] of next) {
        if (!reshaped.has(item)) reshaped.set(item, item.innerHTML);
        item.innerHTML = body;
      }
      state.partly = part;
      if (!state.playing) draw();
    },
    // What another script has put into the drawing of the machine moves with it, and takes the keys of the angle.
    follow: (element, update) => {
      drawing.parts[0].followers.push({ element, update: () => update(state.angle, () => drawing.told.textContent) });
      element.addEventListener("keydown", key);
      if (!state.playing) draw();
    },
    // Where a point is in a turn: [degrees, place] each.
    way: (name) => {
      const spot = animation.spots.find((one) => one.name === name);
      return spot ? animation.knots.map((knot, index) => [knot, [sample(spot.at, index), -sample(spot.at + 1, index)]]) : [];
    },
    spots: () => animation.spots.map(({ name }) => name),
    spotAt: (name) => {
      const spot = animation.spots.find((one) => one.name === name);
      return spot && [value(spot.at), -value(spot.at + 1)];
    },
    // Where the arrow of a load ends, if it is shown.
    tipAt: (name) => {
      const arrows = [...drawing.parts[0].element.querySelectorAll('[data-of-layer="loads"]:not([hidden], [display="none"])')];
      const item = arrows.map((one) => animation.items[one.dataset.i]).find((one) => one.name === name);
      return item && [value(item.to), -value(item.to + 1)];
    },
  });
