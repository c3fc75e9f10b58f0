// The viewer in WebAssembly, as the panels know it: parts that change, and commands. Nothing else
// of the page touches the module. The parts and commands are those of panel_state.hpp and
// panel_command.hpp.

// Why there can be no picture, in words for people.
export class CannotStart extends Error {}

export class Viewer {
  #parts = {};
  #listeners = new Map();
  #labels = () => {};
  #stopped = () => {};
  #module;

  // Calls `listener` with the part of that name now, if it is there, and whenever it changes.
  on(name, listener) {
    if (!this.#listeners.has(name)) this.#listeners.set(name, []);
    this.#listeners.get(name).push(listener);
    if (this.#parts[name]) listener(this.#parts[name]);
  }

  // Calls `listener` once if the module ends by an error of its own: nothing is drawn after that.
  onStop(listener) { this.#stopped = listener; }

  // Calls `listener` with the list of labels whenever one moved.
  onLabels(listener) { this.#labels = listener; }

  // The part as it was last told; undefined before.
  part(name) { return this.#parts[name]; }

  get started() { return this.#module !== undefined; }

  // Draws into the element #canvas from now on. Throws CannotStart.
  async start(options) {
    if (!document.createElement('canvas').getContext('webgl2'))
      throw new CannotStart('This browser offers no WebGL 2, which the picture is drawn with. '
        + 'Another browser, or hardware acceleration in its settings, may help.');
    if (typeof WebAssembly !== 'object')
      throw new CannotStart('This browser runs no WebAssembly, which the viewer is made of.');
    let module;
    try {
      const { default: create } = await import('./viewer.js');
      module = await create({
        onPanels: (text) => this.#hear(JSON.parse(text)),
        onLabels: (text) => this.#labels(JSON.parse(text)),
        onAbort: () => this.#stopped(),
      });
    } catch (error) {
      console.error(error);
      throw new CannotStart('The viewer could not be loaded. Reloading the page may help.');
    }
    this.#module = module;
    const no = this.#call('earthwork_start', options);
    if (!no) return;
    this.#module = undefined;
    throw new CannotStart(`The viewer cannot start: ${no.message}`);
  }

  // Does what a panel asks, {do, ...}. Returns null, or {field, message} that says why not.
  command(command) {
    if (!this.#module) return { field: '', message: 'The viewer is still starting.' };
    return this.#call('earthwork_command', command);
  }

  // Draws now, so that the canvas can be read in the same task.
  draw() { this.#module.ccall('earthwork_screenshot', null, [], []); }

  // What was measured, as figures.hpp says.
  figures() { return JSON.parse(this.#module.ccall('earthwork_figures', 'string', [], [])); }

  #call(name, argument) {
    const answer = this.#module.ccall(name, 'string', ['string'], [JSON.stringify(argument)]);
    return answer ? JSON.parse(answer) : null;
  }

  #hear(parts) {
    Object.assign(this.#parts, parts);
    for (const [name, part] of Object.entries(parts)) {
      for (const listener of this.#listeners.get(name) ?? []) listener(part);
    }
  }
}
