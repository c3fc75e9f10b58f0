/// Functions of the page's own script that the viewer calls: `onPanels` and `onLabels`, given to
/// the module when it was made. One that throws is reported to the browser's console and does no
/// harm here; one that is missing is not called.
#pragma once

#include <string>

namespace earthwork::viewer {

/// JSON as of panel_state.hpp. The page may give commands from within.
void tell_panels(const std::string& json);
void tell_labels(const std::string& json);

}  // namespace earthwork::viewer
