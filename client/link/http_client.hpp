/// A plain HTTP client: one request, one answer, one connection each.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

#include "client/link/server_address.hpp"
#include "protocol/result.hpp"

namespace earthwork::link {

struct HttpBounds {
  std::chrono::milliseconds timeout{10'000};  ///< For reaching the server and for each step after.
  std::size_t max_body_bytes = 1024 * 1024;
};

struct HttpAnswer {
  int status = 0;
  std::string type;  ///< Content-Type.
  std::string etag;
  std::string body;
};

/// `target` begins with '/'. Both wait for the answer and fail with a sentence that names the
/// server when it cannot be reached, does not answer in time, or sends more than the bound; any
/// status is an answer. Safe from any thread.
[[nodiscard]] protocol::Result<HttpAnswer> http_get(const ServerAddress& server,
                                                    std::string_view target,
                                                    const HttpBounds& bounds = {});
/// Posts `body` as application/json.
[[nodiscard]] protocol::Result<HttpAnswer> http_post(const ServerAddress& server,
                                                     std::string_view target, std::string body,
                                                     const HttpBounds& bounds = {});

}  // namespace earthwork::link
