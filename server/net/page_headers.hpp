/// What a browser is told of every page beside its text: where the page may load from, and that
/// nobody may frame it, guess its type, learn of it by links or share its process.
#pragma once

#include "server/net/http_message.hpp"

namespace earthwork::net {

/// `policy` is the page's Content-Security-Policy.
inline void add_page_headers(HttpResponse& response, const char* policy) {
  response.headers.emplace_back("Content-Security-Policy", policy);
  response.headers.emplace_back("X-Content-Type-Options", "nosniff");
  response.headers.emplace_back("Referrer-Policy", "no-referrer");
  response.headers.emplace_back("Cross-Origin-Opener-Policy", "same-origin");
}

}  // namespace earthwork::net
