"use strict";
// What is typed and not yet in the file: one draft per field, by the place of its value.  Knows no elements.
// base: the value of the file that the typing began with; text: what the field shows; due: what is to be written, in
// order; sent: what is on its way to the file.  Each bears the typing that it belongs to, which is undone as a whole.
const drafts = (() => {
  const all = new Map(), page = Math.random().toString(36).slice(2);
  let file = new Map(), count = 0, commits = 0, sure = () => true;

  const typed = (place, text, shown, typing = `${page}.${count}`) => {
    const draft = all.get(place) || { base: shown, due: [], sent: null };
    Object.assign(draft, { text, typing });
    all.set(place, draft);
    if (isVain(place)) all.delete(place);
  };
  // Nothing is to be written: the file has it, and nothing is on its way that could change that.
  const isVain = (place) => {
    const { base, text, due, sent } = all.get(place), there = file.get(place) ?? base;
    return text === there && !due.length && !sent && sure();
  };
  // The file has another value than the one that the draft is based on: neither may be lost.
  const conflict = (place) => {
    const draft = all.get(place), there = file.get(place);
    const parted = draft && !draft.sent && there !== undefined && there !== draft.base && there !== draft.text;
    return parted ? { mine: draft.text, there } : null;
  };
  // After Enter, Tab, a click elsewhere or a pause; returns what is to be written that was not before.  The same text of
  // another typing is: a step back may be on its way between both.
  const commit = (place) => {
    const draft = all.get(place);
    if (!draft) return null;
    // What was refused is not written before what is typed instead.
    if (draft.refused) draft.due = [];
    draft.refused = false;
    const { text, typing, due, sent } = draft, last = due.at(-1);
    if (last?.typing === typing) last.text = text;
    if (last?.typing === typing || sent?.typing === typing && sent.text === text) return null;
    if (isVain(place)) {
      all.delete(place);
      return null;
    }
    due.push({ text, typing, order: commits += 1 });
    return due.at(-1);
  };
  const send = (place, entry) => {
    const draft = all.get(place);
    if (!draft || draft.due[0] !== entry || draft.refused || conflict(place)) return null;
    draft.sent = draft.due.shift();
    // What rested while another change was on its way, and has been typed on since, is half a text: the rest follows.
    if (draft.sent.typing === draft.typing && draft.sent.text !== draft.text) {
      draft.sent = null;
      return null;
    }
    if (draft.sent.text === draft.base) {
      written(place, draft.base);
      return null;
    }
    return { value: draft.sent.text, typing: draft.sent.typing, was: draft.base };
  };
  const written = (place, text) => {
    const draft = all.get(place);
    if (!draft?.sent) return;
    if (draft.typing === draft.sent.typing && draft.text === draft.sent.text && !draft.due.length) all.delete(place);
    Object.assign(draft, { base: text, sent: null });
  };
  // What could not be written is kept, and tried again when the file has changed, unless something else follows it.
  const unwritten = (place) => {
    const draft = all.get(place);
    if (!draft?.sent) return;
    draft.refused = !draft.due.length;
    if (draft.refused) draft.due.push(draft.sent);
    draft.sent = null;
  };
  const isOpen = (place) => {
    const draft = all.get(place);
    return Boolean(draft) && !draft.sent && (!draft.due.length || Boolean(draft.refused) || conflict(place) !== null);
  };
  // The values of the file are known anew, returns whether they are others; after an `own` step back or forth, what is
  // typed meanwhile follows on it.  What was refused is tried `again`.
  const learn = (values, { own = false, again = true } = {}) => {
    const old = file;
    file = values;
    for (const [place, draft] of all) {
      if (again) draft.refused = false;
      if (own && draft.base === old.get(place)) draft.base = file.get(place) ?? draft.base;
      if (isVain(place)) all.delete(place);
    }
    return old.size !== file.size || [...file].some(([place, text]) => old.get(place) !== text);
  };
  const keepMine = (place) => {
    const draft = all.get(place);
    Object.assign(draft, { base: file.get(place), due: [] });
    return commit(place);
  };
  return {
    typed, conflict, commit, send, written, unwritten, isOpen, learn, keepMine,
    // Whether nothing is on its way to the file is for the sender to say.
    sureIf: (says) => { sure = says; },
    // What is typed from here on is a typing by itself; returns its name.
    begin: () => `${page}.${count += 1}`,
    drop: (place) => all.delete(place),
    typing: (place) => all.get(place)?.typing,
    text: (place) => all.get(place)?.text,
    there: (place) => file.get(place),
    places: () => [...all.keys()],
    // What is to be written, [place, entry] each, in the order in which it was typed.
    due: () => [...all].flatMap(([place, { due, refused }]) => (refused ? [] : due.map((entry) => [place, entry]))).sort(([, one], [, next]) => one.order - next.order),
    // What outlives a page that is loaded anew.
    kept: () => [...all].map(([place, { base, text, typing }]) => [place, base, text, typing]),
    restore: (kept) => kept.forEach(([place, base, text, typing]) => { typed(place, text, base, typing); commit(place); }),
  };
})();
