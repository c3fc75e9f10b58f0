// What the viewer asks of the browser beyond emscripten's own html5.h, as functions for C++: linked
// into viewer.js by --js-library. browser.hpp says what each does.
//
// Pointers come by listeners of our own: html5.h knows no pointer events, and so no pens, no
// capture of a drag, and not the points between two pictures.
mergeInto(LibraryManager["library"], {
  // An exception must not pass through WebAssembly: its stack would stay as it was then.
  browser_call_hook: function (name, json) {
    const hook = Module[UTF8ToString(name)];
    try {
      if (hook) hook(UTF8ToString(json));
    } catch (error) {
      setTimeout(() => {
        throw error;
      });
    }
  },

  browser_socket_address: function (out, size) {
    if (!location.host) return 0;
    const scheme = location.protocol === "https:" ? "wss://" : "ws://";
    return stringToUTF8(scheme + location.host + "/ws", out, size);
  },

  // That only the ratio changed, as between two displays, is told by a query for the ratio there
  // is, made anew each time.
  browser_watch_size: function (selector, canvas) {
    const element = document.querySelector(UTF8ToString(selector));
    const tell = () => {
      const box = element.getBoundingClientRect();
      _earthwork_lay_out(canvas, box.width, box.height, window.devicePixelRatio);
    };
    const watchRatio = () => {
      const query = "(resolution: " + window.devicePixelRatio + "dppx)";
      const changed = () => {
        watchRatio();
        tell();
      };
      window.matchMedia(query).addEventListener("change", changed, { once: true });
    };
    tell();
    watchRatio();
    new ResizeObserver(tell).observe(element);
  },

  // A phase is the place of its name in PointerPhase, a kind in PointerKind.
  browser_listen_to_pointers: function (selector, listener) {
    const canvas = document.querySelector(UTF8ToString(selector));
    const down = new Map();
    const kinds = { mouse: 0, pen: 1, touch: 2 };
    const buttonBits = [1, 4, 2];
    const tell = (phase, event, button, last) => {
      const box = canvas.getBoundingClientRect();
      const modifiers =
        event.shiftKey | ((event.ctrlKey || event.metaKey) << 1) | (event.altKey << 2);
      _earthwork_pointer(listener, phase, kinds[event.pointerType] || 0, event.pointerId, button,
        event.clientX - box.left, event.clientY - box.top, modifiers, last);
    };
    const end = (phase, event) => {
      if (down.delete(event.pointerId)) tell(phase, event, event.button, true);
    };
    canvas.style.touchAction = "none";
    canvas.addEventListener("pointerdown", (event) => {
      down.set(event.pointerId, event);
      canvas.setPointerCapture(event.pointerId);
      tell(0, event, event.button, true);
    });
    canvas.addEventListener("pointermove", (event) => {
      // Of several buttons only the first comes as a press and the last as a release.
      if (event.button >= 0) {
        const pressed = event.buttons & buttonBits[event.button];
        tell(pressed ? 0 : 2, event, event.button, true);
        return;
      }
      const path = down.size && event.getCoalescedEvents ? event.getCoalescedEvents() : [];
      path.slice(0, -1).forEach((point) => tell(1, point, -1, false));
      tell(1, event, -1, true);
    });
    canvas.addEventListener("pointerup", (event) => end(2, event));
    canvas.addEventListener("pointercancel", (event) => end(3, event));
    // Without a release before: another button's menu took it, and no release would be told.
    canvas.addEventListener("lostpointercapture", (event) => end(3, event));
    canvas.addEventListener("pointerleave", (event) => {
      if (!down.has(event.pointerId)) tell(4, event, -1, true);
    });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    // With the middle button, browsers would scroll.
    canvas.addEventListener("mousedown", (event) => {
      if (event.button === 1) event.preventDefault();
    });
    window.addEventListener("blur", () => down.forEach((event) => end(3, event)));
  },

  browser_focus: function (selector) {
    const at = document.activeElement;
    if (!at || at === document.body || at.matches(UTF8ToString(selector))) return 0;
    if (at.closest("dialog,[role=dialog],[role=menu],[role=listbox]")) return 1;
    if (at.isContentEditable || at.matches("textarea,select")) return 1;
    const moves = "input[type=range],input[type=radio],[role=slider],[role=radio],[role=tab]";
    if (at.matches(moves)) return 2;
    const presses = "input[type=checkbox],input[type=color],input[type=button],input[type=submit]";
    if (at.matches(presses) || at.matches("button,a[href],summary,[role=button]")) return 3;
    return at.matches("input") ? 1 : 2;
  },
});
