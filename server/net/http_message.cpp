#include "server/net/http_message.hpp"

#include <nlohmann/json.hpp>

namespace earthwork::net {
namespace {

using protocol::Code;

int status_of(Code code) {
  switch (code) {
    case Code::unknown_map:
      return 404;
    case Code::map_exists:
      return 409;
    case Code::bad_state:
      return 409;
    case Code::too_large:
      return 413;
    case Code::not_supported:
      return 501;
    case Code::timeout:
      return 408;
    case Code::too_fast:
      return 429;
    case Code::shutting_down:
      return 503;
    case Code::disk_full:
      return 507;
    case Code::read_only:
    case Code::storage_failed:
    case Code::unavailable:
      return 503;
    case Code::damaged:
    case Code::internal:
      return 500;
    default:
      return 400;
  }
}

const char* title_of(int status) {
  switch (status) {
    case 400:
      return "Bad request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not found";
    case 405:
      return "Method not allowed";
    case 408:
      return "Request timeout";
    case 409:
      return "Conflict";
    case 413:
      return "Too large";
    case 415:
      return "Unsupported media type";
    case 422:
      return "Cannot be made";
    case 426:
      return "Upgrade required";
    case 429:
      return "Too many requests";
    case 431:
      return "Header too large";
    case 501:
      return "Not supported";
    case 503:
      return "Not now";
    case 507:
      return "No room left";
    default:
      return "Server error";
  }
}

}  // namespace

HttpResponse json_response(int status, const nlohmann::ordered_json& body) {
  return {.status = status,
          .content_type = "application/json",
          .headers = {},
          .body = body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n"};
}

HttpResponse text_response(std::string text) {
  return {.status = 200,
          .content_type = "text/plain; charset=utf-8",
          .headers = {},
          .body = std::move(text)};
}

HttpResponse problem(int status, const protocol::Failure& failure) {
  nlohmann::ordered_json body{{"type", "urn:earthwork:" + std::string(name(failure.code))},
                              {"title", title_of(status)},
                              {"status", status},
                              {"detail", failure.detail}};
  if (!failure.field.empty()) body["field"] = failure.field;
  HttpResponse response = json_response(status, body);
  response.content_type = "application/problem+json";
  return response;
}

HttpResponse problem(const protocol::Failure& failure) {
  HttpResponse response = problem(status_of(failure.code), failure);
  if (response.status == 503) response.headers.emplace_back("Retry-After", "1");
  return response;
}

}  // namespace earthwork::net
