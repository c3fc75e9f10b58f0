// Who is on a map and where they point: what `joined` lists, kept up to date by `presence`.

// From session to {session, name, color, author, cursor?}; `cursor` is {x, y, brush?} for somebody
// who points.
export class People extends Map {
  constructor(users = []) {
    super();
    this.#welcome(users);
  }

  // Takes a presence message. Returns the sessions of which something changed.
  apply({ all = false, users = [], left = [], cursors = [] }) {
    const changed = new Set([...users, ...cursors].map(({ session }) => session));
    if (all) {
      const stays = new Set(users.map(({ session }) => session));
      left = [...this.keys()].filter((session) => !stays.has(session));
    }
    for (const session of left) if (this.delete(session)) changed.add(session);
    this.#welcome(users);
    for (const cursor of cursors) this.#move(cursor);
    return [...changed];
  }

  #welcome(users) {
    for (const user of users) this.set(user.session, { ...user });
  }

  #move({ session, hidden, x, y, brush }) {
    const person = this.get(session);
    if (!person) return;
    if (hidden) delete person.cursor;
    else person.cursor = { x, y, brush };
  }
}
