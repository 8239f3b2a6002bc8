// Cells that the server has not confirmed yet. They stay in the browser's storage, one entry a cell, until it has them.

const PREFIX = "reportgen:";

export class Outbox {
  constructor(owner) {
    this.prefix = `${PREFIX}${owner}:`;
    // Without a storage (private windows, a full disk) the cells stay in this page alone.
    this.memory = new Map();
  }

  key(id, position) {
    return `${this.prefix}${id}@${position}`;
  }

  put(item) {
    const key = this.key(item.id, item.position);
    this.memory.set(key, item);
    try {
      localStorage.setItem(key, JSON.stringify(item));
    } catch {
      // The page still has it.
    }
  }

  get(id, position) {
    const key = this.key(id, position);
    return this.memory.get(key) ?? this.stored(key);
  }

  stored(key) {
    try {
      return JSON.parse(localStorage.getItem(key)) ?? undefined;
    } catch {
      return undefined;
    }
  }

  // Forgets what was confirmed, unless something newer was typed in the meantime.
  remove(item) {
    const key = this.key(item.id, item.position);
    if (this.memory.get(key)?.client === item.client) this.memory.delete(key);
    if (this.stored(key)?.client === item.client) localStorage.removeItem(key);
  }

  all() {
    const items = new Map(this.memory);
    try {
      for (const key of Object.keys(localStorage)) {
        if (!key.startsWith(this.prefix) || items.has(key)) continue;
        const item = this.stored(key);
        if (item) items.set(key, item);
      }
    } catch {
      // No storage.
    }
    return [...items.values()];
  }
}

// Checks without an answer yet: each is sent again, even after the page was loaded anew, by the same id and counts once.
export class Unanswered {
  constructor(owner, newId) {
    this.key = `reportgen-check:${owner}`;
    this.newId = newId;
    this.memory = undefined;
  }

  // Return the id of a check. With other cells it is another check.
  ask(asked, cells) {
    const known = this.memory ?? this.stored();
    this.memory = known?.cells === cells ? known : { cells, ids: {} };
    this.memory.ids[asked] ??= this.newId();
    this.store();
    return this.memory.ids[asked];
  }

  end(asked) {
    delete this.memory?.ids[asked];
    this.store();
  }

  stored() {
    try {
      return JSON.parse(localStorage.getItem(this.key)) ?? undefined;
    } catch {
      return undefined;
    }
  }

  store() {
    try {
      if (Object.keys(this.memory?.ids ?? {}).length) localStorage.setItem(this.key, JSON.stringify(this.memory));
      else localStorage.removeItem(this.key);
    } catch {
      // The page still has it.
    }
  }
}
