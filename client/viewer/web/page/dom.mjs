// Small helpers around the document, which every panel needs.

export const byId = (id) => document.getElementById(id);

// An element with properties ("class" and names with a dash or "role" become attributes), and its
// children: elements or text.
export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name in element) element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

const SVG = 'http://www.w3.org/2000/svg';

// One of the symbols of index.html, for eyes only.
export function icon(name, small = false) {
  const svg = document.createElementNS(SVG, 'svg');
  const use = document.createElementNS(SVG, 'use');
  svg.setAttribute('class', small ? 'icon small' : 'icon');
  svg.setAttribute('aria-hidden', 'true');
  use.setAttribute('href', `#i-${name}`);
  svg.append(use);
  return svg;
}

export function iconButton(name, label, onClick) {
  const button = make('button', { type: 'button', className: 'icon-button' }, icon(name));
  nameButton(button, label);
  button.addEventListener('click', onClick);
  return button;
}

export function nameButton(button, label) {
  button.setAttribute('aria-label', label);
  button.title = label;
}

export function setIcon(button, name) {
  button.querySelector('use').setAttribute('href', `#i-${name}`);
}

export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

// Nobody's typing is overwritten by what arrives meanwhile.
export function setValue(input, value) {
  if (document.activeElement !== input && input.value !== value) input.value = value;
}

// Writes words of an error below a form, and marks the field that is meant; null: there is none.
export function showError(place, words, input = null) {
  for (const marked of document.querySelectorAll(`[aria-describedby~="${place.id}"][aria-invalid]`))
    marked.removeAttribute('aria-invalid');
  setText(place, words ?? '');
  if (!words || !input) return;
  input.setAttribute('aria-describedby', place.id);
  input.setAttribute('aria-invalid', 'true');
}

// Opens it as a dialog does; what had the focus gets it back. A click beside it closes it.
export function dialog(element) {
  element.addEventListener('click', (event) => {
    if (event.target === element || event.target.closest('[data-close]')) element.close();
  });
  return () => { if (!element.open) element.showModal(); };
}
