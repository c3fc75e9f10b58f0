/// What a browser is shown at '/' by a server that has no viewer to serve.
#pragma once

#include "server/net/http_message.hpp"

namespace earthwork::net {

[[nodiscard]] HttpResponse front_page();

}  // namespace earthwork::net
