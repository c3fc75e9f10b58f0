/// What a browser is shown at '/'.
#pragma once

#include "server/net/http_message.hpp"

namespace earthwork::net {

[[nodiscard]] HttpResponse front_page();

}  // namespace earthwork::net
