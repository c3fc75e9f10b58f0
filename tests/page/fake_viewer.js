// Stands in for the viewer in WebAssembly where only panels are tested: the same three functions
// and two hooks, without a server. Tests reach it as window.fake: `commands` are those that came,
// `tell(parts)` and `label(list)` call the hooks, `refuse` is the answer to the next command.
export default async function create(hooks) {
  const canvas = document.getElementById('canvas');
  const parts = {};
  const fake = {
    commands: [],
    refuse: null,
    draws: 0,
    tell(change) {
      Object.assign(parts, structuredClone(change));
      hooks.onPanels(JSON.stringify(change));
    },
    label(labels) { hooks.onLabels(JSON.stringify(labels)); },
  };

  function start(options) {
    fake.options = options;
    fake.tell({
      connection: { state: 'joined', words: 'Connected.', key: 'f'.repeat(32), session: 's1' },
      map: mapPart(options.map),
      brush: { tool: 'paint', stencil: 'circle', fill: true, radius: 3, layer: 0, snap: 'none' },
      people: { people: [
        { session: 's1', name: options.name, color: options.color, me: true, view: true,
          followed: false }] },
      chat: { lines: [] },
      status: { seq: 1234, latency_ms: 3.21, fps: 60, bytes: 1_234_567, chunks: 64,
        triangles: 12_345, unanswered: 0, caught_up: true },
      camera: { x: 0, y: 0, zoom: 16, yaw: 0, tilt: 0, ...options.place },
      notices: { notices: [] },
      shortcuts: { shortcuts: [{ keys: ['f'], does: 'Fill' }, { keys: ['+', '='], does: 'Zoom in' },
        { keys: ['ArrowLeft'], does: 'Move left' }] },
    });
    drawIn(canvas);
    return '';
  }

  const does = {
    tool: ({ tool }) => fake.tell({ brush: { ...parts.brush, tool } }),
    brush: (change) => fake.tell({ brush: { ...parts.brush, ...change } }),
    show: ({ layer, visible }) => {
      const hidden = parts.map.hidden.filter((index) => index !== layer);
      fake.tell({ map: { ...parts.map, hidden: visible ? hidden : [...hidden, layer] } });
    },
    layer: ({ layer, ...change }) => {
      const map = structuredClone(parts.map);
      const { layers } = map.settings;
      if (layer === undefined)
        layers.push({ name: `layer ${layers.length + 1}`, color: '#8a9a5b', wall: [-1, 0] });
      Object.assign(layers[layer ?? layers.length - 1], change);
      fake.tell({ map });
    },
    camera: ({ action, ...place }) => {
      if (!action) fake.tell({ camera: { ...parts.camera, ...place } });
    },
    follow: ({ session }) => fake.tell({ people: { people: parts.people.people.map((person) =>
      ({ ...person, followed: person.session === session })) } }),
    person: ({ name, color }) => fake.tell({ people: { people: parts.people.people.map((person) =>
      (person.me ? { ...person, name, color } : person)) } }),
    join: ({ map }) => fake.tell({ map: mapPart(map) }),
    chat: () => {},
    retry: () => {},
  };
  function command({ do: name, ...fields }) {
    fake.commands.push({ do: name, ...fields });
    if (fake.refuse) {
      const answer = JSON.stringify(fake.refuse);
      fake.refuse = null;
      return answer;
    }
    delete fields.do;
    does[name](fields);
    return '';
  }

  window.fake = fake;
  return {
    ccall(name, _result, _types, values) {
      if (name === 'earthwork_start') return start(JSON.parse(values[0]));
      if (name === 'earthwork_command') return command(JSON.parse(values[0]));
      if (name === 'earthwork_screenshot') {
        ++fake.draws;
        return drawIn(canvas);
      }
      throw new Error(`no function ${name}`);
    },
  };
}

function mapPart(name) {
  return {
    name, epoch: 'fedcba9876543210', hidden: [],
    settings: { chunk_resolution: 32, voxel_size: 1, max_feature_angle: 135,
      layers: [{ name: 'ground', color: '#8a9a5b', wall: [-1, 0] }] },
  };
}

// Something to be seen, so that a picture of the canvas is not an empty one.
function drawIn(canvas) {
  const ratio = window.devicePixelRatio;
  canvas.width = canvas.clientWidth * ratio;
  canvas.height = canvas.clientHeight * ratio;
  const pen = canvas.getContext('2d');
  pen.fillStyle = '#d8d5c8';
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.fillStyle = '#8a9a5b';
  pen.beginPath();
  pen.arc(canvas.width / 2, canvas.height / 2, canvas.height / 4, 0, 2 * Math.PI);
  pen.fill();
}
