#include "client/viewer/web/hooks.hpp"

#include "client/viewer/web/browser.hpp"

namespace earthwork::viewer {

void tell_panels(const std::string& json) { browser_call_hook("onPanels", json.c_str()); }
void tell_labels(const std::string& json) { browser_call_hook("onLabels", json.c_str()); }

}  // namespace earthwork::viewer
