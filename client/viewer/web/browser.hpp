/// What browser_library.js offers to C++. Selectors name the canvas; strings end with a NUL.
#pragma once

extern "C" {

/// Calls a function that the page gave to the module under that name, if it did. When it throws,
/// the browser's console is told, and nobody here.
void browser_call_hook(const char* name, const char* json);

/// Writes the address of /ws on the page's own host, encrypted as the page is. Gives back the bytes
/// without the NUL, 0 when the page came from no host.
int browser_socket_address(char* out, int size);

/// Calls earthwork_lay_out(canvas, ...) at once, and whenever the page lays the element out anew or
/// the display becomes finer or coarser.
void browser_watch_size(const char* selector, void* canvas);

/// Calls earthwork_pointer(listener, ...) for all that points at the element or began there. What
/// is down is cancelled when the window loses the keyboard. The browser's own gestures there end.
void browser_listen_to_pointers(const char* selector, void* listener);

/// What has the keyboard's focus: the number of a Focus.
int browser_focus(const char* selector);
}
