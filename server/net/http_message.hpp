/// What of an HTTP request matters here, and the answers to it.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "protocol/result.hpp"

namespace earthwork::net {

/// A header that was not sent is nullopt.
struct HttpRequest {
  std::string method, target;
  std::optional<std::string> host, origin, content_type, accept_encoding, if_none_match;
  std::string body;
};

/// Bytes that many answers have in common.
using SharedBody = std::shared_ptr<const std::string>;

struct HttpResponse {
  int status = 200;
  std::string content_type;  ///< Empty: no body.
  std::vector<std::pair<std::string, std::string>> headers;
  std::string body;
  SharedBody shared_body{};  ///< Unless null it is sent in place of `body`.

  [[nodiscard]] const std::string& bytes() const { return shared_body ? *shared_body : body; }
};

/// Takes the one answer to a request. Any thread may call it.
using Respond = std::function<void(HttpResponse)>;

[[nodiscard]] HttpResponse json_response(int status, const nlohmann::ordered_json& body);
[[nodiscard]] HttpResponse text_response(std::string text);
/// A problem document (RFC 9457): type, title, status, detail, and field unless empty.
[[nodiscard]] HttpResponse problem(int status, const protocol::Failure& failure);
/// The same, with the status that belongs to the failure's code, and when to come back with a 503.
[[nodiscard]] HttpResponse problem(const protocol::Failure& failure);

}  // namespace earthwork::net
