// What one paints with: tool, fill or empty, stencil, radius, snap. On a narrow screen the bar has
// two of them at hand.
import { byId, setIcon, setText, setValue, showError } from './dom.mjs';

const rounded = (value) => String(Math.round(value * 100) / 100);

export function brushPanel(viewer) {
  const form = byId('brush-body');
  const [slider, radius, error] = [byId('radius-slider'), byId('radius'), byId('brush-error')];
  const [quickTool, quickFill] = [byId('quick-tool'), byId('quick-fill')];

  const ask = (command, input) => showError(error, viewer.command(command)?.message, input);
  const brush = (change, input) => ask({ do: 'brush', ...change }, input);
  const askRadius = (input) => {
    if (input.value !== '') brush({ radius: Number(input.value) }, input);
  };

  // Enter in the field of the radius: back to the map, whose keys are to work again.
  form.addEventListener('submit', (event) => {
    event.preventDefault();
    if (document.activeElement === radius && !error.textContent) byId('canvas').focus();
  });
  form.addEventListener('change', ({ target }) => {
    if (target.name === 'tool') ask({ do: 'tool', tool: target.value });
    if (target.name === 'fill') brush({ fill: target.value === 'fill' });
    if (target.name === 'stencil') brush({ stencil: target.value });
    if (target.name === 'snap') brush({ snap: target.value });
  });
  slider.addEventListener('input', () => askRadius(slider));
  radius.addEventListener('change', () => {
    if (radius.value === '' && now()) radius.value = rounded(now().radius);
    else askRadius(radius);
  });

  const now = () => viewer.part('brush');
  quickTool.addEventListener('click', () =>
    ask({ do: 'tool', tool: now()?.tool === 'paint' ? 'move' : 'paint' }));
  quickFill.addEventListener('click', () => brush({ fill: !now()?.fill }));

  viewer.on('brush', (part) => {
    const fill = part.fill ? 'fill' : 'empty';
    for (const [name, value] of Object.entries({ ...part, fill }))
      if (form.elements[name] instanceof RadioNodeList) form.elements[name].value = value;
    slider.value = part.radius;
    slider.style.setProperty('--part', `${part.radius / 50 * 100}%`);
    setValue(radius, rounded(part.radius));
    setIcon(quickTool, part.tool);
    setText(quickTool.lastElementChild, part.tool === 'paint' ? 'Paint' : 'Move');
    setIcon(quickFill, fill);
    setText(quickFill.lastElementChild, part.fill ? 'Fill' : 'Empty');
  });
}
