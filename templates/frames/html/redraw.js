"use strict";
// Makes a form that of newer elements and leaves in their places all that stay: a field that has the focus keeps it, with
// what is typed and selected, and no element that is there before and after is ever taken out.
const redraw = (() => {
  const FIELD = "input, select, textarea";
  const key = (node) => node.id || node.dataset?.key || node.dataset?.w || node.dataset?.open || "";
  const name = (node) => `${node.nodeName} ${key(node)}`;

  // A value that is changed under a caret: what was selected as a whole still is, so that the next key replaces it.
  const put = (field, value) => {
    if (field.value === value) return;
    const { selectionStart: from, selectionEnd: to, value: old } = field;
    field.value = value;
    if (field !== document.activeElement || typeof from !== "number") return;
    field.setSelectionRange(Math.min(from, value.length), to === old.length ? value.length : Math.min(to, value.length));
  };
  const attributes = (old, next) => {
    // A field that the pointer is on stays marked; what a reader has opened stays open.
    if (old.classList.contains("own")) next.classList.add("own");
    const left = (attribute) => attribute === "open" || attribute === "value" && old.matches("input");
    for (const { name: one, value } of next.attributes) if (!left(one) && old.getAttribute(one) !== value) old.setAttribute(one, value);
    for (const { name: one } of [...old.attributes]) if (!left(one) && !next.hasAttribute(one)) old.removeAttribute(one);
  };
  const same = (old, next) => {
    if (old.nodeType !== Node.ELEMENT_NODE) {
      if (old.data !== next.data) old.data = next.data;
      return;
    }
    attributes(old, next);
    children(old, next);
    if (old.matches(FIELD) && old.dataset.loose === undefined) put(old, next.value);
  };
  const children = (old, next) => {
    const focused = document.activeElement, likes = new Map(), wanted = [...next.childNodes];
    for (const node of old.childNodes) likes.set(name(node), [...(likes.get(name(node)) || []), node]);
    const pairs = wanted.map((node) => [node, likes.get(name(node))?.shift()]);
    for (const node of [...likes.values()].flat()) if (!node.contains(focused) || !focused.matches(FIELD)) node.remove();
    let here = old.firstChild;
    for (const [node, like] of pairs) {
      // What stays only for its focus stays where it is.
      while (here?.contains(focused) && !pairs.some(([, one]) => one === here)) here = here.nextSibling;
      if (!like) {
        old.insertBefore(node, here);
        continue;
      }
      if (like.contains(focused)) {
        // What has the focus stays, what is before it goes behind.
        while (here !== like) {
          const passed = here;
          here = here.nextSibling;
          old.append(passed);
        }
      } else if (like !== here) old.insertBefore(like, here);
      if (like === here) here = here.nextSibling;
      same(like, node);
    }
  };
  // The way from a field to its form.
  const home = (node, root) => {
    const steps = [];
    for (let above = node.parentElement; above && above !== root; above = above.parentElement) steps.push(name(above));
    return steps.join();
  };

  // Returns whether a field stays only for its focus, where the newer form has it elsewhere or not at all.
  return (form, next) => {
    const focused = form.contains(document.activeElement) && document.activeElement.matches(FIELD) ? document.activeElement : null;
    const field = focused?.closest(".field") || focused, sought = field && name(field);
    const twin = field && key(field) ? [...next.querySelectorAll(field.nodeName)].find((one) => name(one) === sought) : null;
    const strays = Boolean(field) && !(twin && home(twin, next) === home(field, form)) && Boolean(key(field));
    if (strays && twin) {
      same(field, twin);
      twin.remove();
    }
    children(form, next);
    return strays;
  };
})();
