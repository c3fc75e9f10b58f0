// Who is at the map, and whose view one follows.
import { byId, icon, iconButton, make, nameButton, setText } from './dom.mjs';

// `editPerson` opens the dialog about oneself.
export function peoplePanel(viewer, editPerson) {
  const list = byId('people-list');
  const rows = new Map();

  byId('following-stop').addEventListener('click', () => {
    viewer.command({ do: 'follow' });
    byId('canvas').focus();
  });

  viewer.on('people', ({ people }) => {
    setText(byId('people-count'), String(people.length));
    const gone = new Set(rows.keys());
    people.forEach((person, index) => {
      if (!rows.has(person.session)) rows.set(person.session, personRow(viewer, person, editPerson));
      gone.delete(person.session);
      const row = rows.get(person.session);
      row.show(person);
      if (list.children[index] !== row.element) list.insertBefore(row.element, list.children[index]);
    });
    for (const session of gone) {
      rows.get(session).element.remove();
      rows.delete(session);
    }
    const followed = people.find((person) => person.followed);
    byId('following').hidden = !followed;
    if (followed) setText(byId('following-words'), `Following ${followed.name}`);
  });
}

function personRow(viewer, { session, me }, editPerson) {
  const dot = make('span', { className: 'person-dot' });
  const name = make('span', { className: 'person-name' });
  let followed = false;
  const button = me
    ? iconButton('edit', 'Change your name and colour', editPerson)
    : make('button', { type: 'button', className: 'follow' }, icon('follow', true), 'Follow');
  if (!me) {
    button.addEventListener('click', () =>
      viewer.command(followed ? { do: 'follow' } : { do: 'follow', session }));
  }
  return {
    element: make('li', {}, dot, name, ...(me ? [make('span', { className: 'you' }, 'you')] : []),
      button),
    show(person) {
      dot.style.background = person.color;
      setText(name, person.name);
      if (me) return;
      ({ followed } = person);
      button.setAttribute('aria-pressed', String(followed));
      button.disabled = !person.view && !followed;
      nameButton(button, followed ? `Stop following ${person.name}` : `Follow ${person.name}`);
      setText(button.lastChild, followed ? 'Following' : 'Follow');
    },
  };
}
