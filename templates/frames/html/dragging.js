"use strict";
// What a form asks and sends, as JSON.
const post = (name, body, more) => fetch(name, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body), ...more });

// While a slider is dragged or a point is pulled, only what moves in sight follows: the newest value is asked for when the
// last one is there.  All the rest follows when it rests.
const dragging = (() => {
  const machine = typeof panels === "undefined" ? undefined : panels[0];
  const WHOLE = 300;

  let wanted = null, asking = false, turn = 0, answered, partly = null, later = 0, ahead = null, texts = null;
  const ask = (name, body, took = () => {}, whole = false) => {
    clearTimeout(later);
    wanted = { name, body, took, of: turn, whole };
    // Settled when there is no more to ask.
    if (!asking) answered = follow();
    return answered;
  };
  const next = () => {
    if (!wanted) return null;
    const asked = { ...wanted, sight: wanted.whole || !machine ? null : extended.get(machine.root)?.sight() };
    wanted = null;
    return { ...asked, answer: post(asked.name, { ...asked.body, seen: asked.sight }).then(received).catch(() => null) };
  };
  const received = async (answer) =>
    answer.headers.get("Content-Type") === "application/json" ? { said: await answer.json() }
      : { samples: answer.ok ? await answer.arrayBuffer() : new ArrayBuffer(0) };
  const take = ({ said, samples }, { name, body, took, sight }) => {
    if (said) { took(said); return; }
    document.body.classList.toggle("stale", !samples.byteLength);
    if (!samples.byteLength) return;
    const length = new DataView(samples).getUint32(0, true);
    const changes = JSON.parse(new TextDecoder().decode(new Uint8Array(samples, 4, length)));
    // Changes of another machine than the page shows are no changes of that; those of a newer one wait for it.
    const show = () => {
      extended.get(machine?.root)?.feed(new Float32Array(samples, 4 + length), changes, Boolean(sight));
      partly = sight ? { name, body, of: changes.of } : null;
    };
    const shown = Number(document.body.dataset.moving);
    if (changes.of < shown) return;
    if (changes.of > shown) ahead = { of: changes.of, show }; else show();
    texts = changes.texts || body.values || [[body.where, body.value]];
    took(changes);
    document.body.dataset.drawn = body.value ?? "";
  };
  const follow = async () => {
    asking = true;
    for (let asked = next(); asked;) {
      const present = asked, answer = await present.answer;
      // The server computes the next value while this one is drawn.
      asked = next();
      try { if (answer && present.of === turn) take(answer, present); } catch { /* the next value is drawn anew */ }
    }
    asking = false;
    if (partly) later = setTimeout(askWhole, WHOLE);
  };
  const askWhole = () => {
    // A renewed machine may be shown whole meanwhile.
    if (!partly) return;
    const { name, body, of } = partly;
    partly = null;
    if (String(of) === document.body.dataset.moving) ask(name, body, () => {}, true);
  };
  // A machine that is renewed in the middle of a pull is shown as it is pulled.  What was written has no draft: of that
  // the file is right, also after Undo.
  const pending = () => (texts || []).filter(([where]) => drafts.places().some((key) => JSON.parse(key).every((step, index) => step === where[index])));
  document.addEventListener("renewing", ({ detail }) => {
    texts = pending();
    // A newer value that waits is not replaced.
    if (texts.length) detail.push(wanted ? answered : ask("drag.json", { values: texts }));
  });
  document.addEventListener("showing", () => {
    if (!ahead || String(ahead.of) !== document.body.dataset.moving) return;
    ahead.show();
    ahead = null;
    clearTimeout(later);
    if (partly && !asking) later = setTimeout(askWhole, WHOLE);
  });
  // The machine is again as the file has it, and what is asked for comes to nothing.
  const takeBack = () => {
    wanted = partly = ahead = texts = null;
    clearTimeout(later);
    turn += 1;
    if (machine) extended.get(machine.root)?.feed(new Float32Array(0), { bodies: {}, runs: [] });
  };
  return { ask, takeBack };
})();
