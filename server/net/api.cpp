#include "server/net/api.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "protocol/json_fields.hpp"
#include "protocol/json_text.hpp"
#include "server/net/front_page.hpp"
#include "server/net/map_question.hpp"
#include "server/net/map_resource.hpp"
#include "server/net/metrics.hpp"
#include "server/net/survey.hpp"

namespace earthwork::net {
namespace {

using nlohmann::ordered_json;
using protocol::Code;

HttpResponse not_found(const std::string& target) {
  return problem(404, {Code::unknown_map, "there is no " + target.substr(0, 200), {}});
}

/// Whether the method is one of `allowed`; answers 405 when not. HEAD goes wherever GET does.
bool check_method(const HttpRequest& request, std::initializer_list<const char*> allowed,
                  const Respond& respond) {
  std::string list;
  for (const char* method : allowed) {
    if (request.method == method) return true;
    list += (list.empty() ? "" : ", ") + std::string(method);
    if (std::string_view(method) != "GET") continue;
    if (request.method == "HEAD") return true;
    list += ", HEAD";
  }
  HttpResponse response = problem(405, {Code::not_supported, "use one of " + list, {}});
  response.headers.emplace_back("Allow", list);
  respond(std::move(response));
  return false;
}

/// A page of another site can send a form here, but not JSON: so what writes has to be JSON.
bool is_json(const std::optional<std::string>& content_type) {
  if (!content_type) return false;
  std::string_view type = *content_type;
  type = type.substr(0, type.find(';'));
  type = type.substr(0, type.find_last_not_of(" \t") + 1);
  constexpr std::string_view kJson = "application/json";
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  return std::equal(type.begin(), type.end(), kJson.begin(), kJson.end(), same);
}

HttpResponse not_json() {
  return problem(415,
                 {Code::bad_field, "Content-Type: application/json is needed", "Content-Type"});
}

/// A number from the query, `missing` without one; nothing when it is no number.
std::optional<std::uint64_t> number(const Target& target, std::string_view key,
                                    std::uint64_t missing) {
  const auto text = target.asked(key);
  if (!text) return missing;
  std::uint64_t value = 0;
  const char* end = text->data() + text->size();
  const auto [last, error] = std::from_chars(text->data(), end, value);
  if (error != std::errc{} || last != end) return std::nullopt;
  return value;
}

tl::unexpected<protocol::Failure> no_number(const char* key) {
  return protocol::fail(Code::bad_field, std::string(key) + ": a whole number is needed", key);
}

struct NewMap {
  std::string name;
  protocol::MapSettings settings;
};

protocol::Result<NewMap> read_new_map(std::string_view body) {
  const auto json = protocol::parse_json(body, kMaxBodyBytes);
  if (!json) return tl::unexpected<protocol::Failure>(json.error());
  protocol::JsonFields in(*json);
  NewMap wanted{.name = in.map_name("name"), .settings = {}};
  if (in.has("settings")) {
    if (const nlohmann::json* object = in.value("settings")) {
      auto settings = protocol::read_settings(*object);
      if (!settings) return tl::unexpected<protocol::Failure>(std::move(settings.error()));
      wanted.settings = std::move(*settings);
    }
  }
  return in.result(std::move(wanted));
}

}  // namespace

Api::Api(room::Atlas& atlas, Workers& workers, Access access, std::shared_ptr<const PageFiles> page)
    : atlas_(atlas),
      survey_(std::make_shared<Survey>(atlas)),
      workers_(workers),
      access_(std::move(access)),
      page_(std::move(page)) {}

std::optional<HttpResponse> Api::refuse_access(const HttpRequest& request) const {
  // Of a header sent twice the values come with a comma between them, which no name has.
  if (!request.host || request.host->find(',') != std::string::npos)
    return problem(400, {Code::bad_field, "Host: exactly one is needed", "Host"});
  const auto target = parse_target(request.target);
  const auto& host = target && target->authority ? target->authority : request.host;
  if (auto checked = access_.check(host, request.origin); !checked)
    return problem(403, checked.error());
  return std::nullopt;
}

void Api::handle(HttpRequest request, Respond respond) const {
  if (auto refusal = refuse_access(request)) return respond(std::move(*refusal));
  const auto target = parse_target(request.target);
  if (!target) return respond(not_found(request.target));

  const auto& path = target->segments;
  if (path == std::vector<std::string>{"healthz"}) {
    if (!check_method(request, {"GET"}, respond)) return;
    return respond(text_response("ok\n"));
  }
  if (path == std::vector<std::string>{"ws"}) {
    if (!check_method(request, {"GET"}, respond)) return;
    HttpResponse response =
        problem(426, {Code::bad_version, "this is where WebSockets are opened", {}});
    response.headers.emplace_back("Upgrade", "websocket");
    return respond(std::move(response));
  }
  if (path == std::vector<std::string>{"metrics"}) {
    if (!check_method(request, {"GET"}, respond)) return;
    return give_metrics(std::move(respond));
  }
  if (path.size() >= 2 && path[0] == "api" && path[1] == "maps") {
    if (path.size() == 2) return handle_maps(request, std::move(respond));
    if (path.size() <= 4) return handle_map(request, *target, std::move(respond));
  }
  auto page = page_answer(request, *target);
  if (!page) return respond(not_found(request.target));
  if (check_method(request, {"GET"}, respond)) respond(std::move(*page));
}

std::optional<HttpResponse> Api::page_answer(const HttpRequest& request,
                                             const Target& target) const {
  if (target.segments.size() > 1) return std::nullopt;
  if (page_)
    return page_->answer(target.segments.empty() ? "index.html" : target.segments[0], request);
  if (target.segments.empty()) return front_page();
  return std::nullopt;
}

void Api::handle_maps(const HttpRequest& request, Respond respond) const {
  if (!check_method(request, {"GET", "POST"}, respond)) return;
  if (request.method == "POST") return create_map(request, std::move(respond));
  list_maps(respond);
}

void Api::list_maps(const Respond& respond) const {
  ordered_json maps = ordered_json::array();
  for (const auto& [name, epoch] : atlas_.list()) {
    ordered_json map{{"name", name}};
    if (epoch) map["epoch"] = protocol::hex(*epoch);
    maps.push_back(std::move(map));
  }
  respond(json_response(200, {{"maps", std::move(maps)}}));
}

void Api::give_metrics(Respond respond) const {
  survey_->ask([&meters = atlas_.meters(), respond = std::move(respond)](const MapTotals& totals) {
    HttpResponse response = text_response(metrics_text(meters, totals, own_usage()));
    response.content_type = kMetricsContentType;
    respond(std::move(response));
  });
}

void Api::create_map(const HttpRequest& request, Respond respond) const {
  if (!is_json(request.content_type)) return respond(not_json());
  const auto wanted = read_new_map(request.body);
  if (!wanted) return respond(problem(wanted.error()));
  auto created = [&atlas = atlas_, name = wanted->name,
                  respond](const protocol::Result<RoomPointer>& room) {
    if (!room) {
      const bool full = room.error().code == Code::too_large;
      return respond(full ? problem(507, room.error()) : problem(room.error()));
    }
    const auto describe = [](const RoomPointer& there, Given give) {
      describe_map(there, 201, std::move(give));
    };
    ask_map(atlas, name, describe, respond);
  };
  atlas_.create(wanted->name, wanted->settings, std::move(created));
}

void Api::delete_map(const HttpRequest& request, const std::string& name, Respond respond) const {
  // A page of another site cannot send a DELETE unasked, with a body or without.
  if (!request.body.empty() && !is_json(request.content_type)) return respond(not_json());
  atlas_.erase(name, [respond = std::move(respond)](const protocol::Result<void>& erased) {
    if (!erased) return respond(map_problem(erased.error()));
    respond({.status = 204, .content_type = {}, .headers = {}, .body = {}});
  });
}

void Api::handle_map(const HttpRequest& request, const Target& target, Respond respond) const {
  const std::string& name = target.segments[2];
  const std::string part = target.segments.size() == 4 ? target.segments[3] : "";
  if (!protocol::valid_map_name(name)) return respond(not_found(request.target));
  if (part.empty()) {
    if (!check_method(request, {"GET", "DELETE"}, respond)) return;
    if (request.method == "DELETE") return delete_map(request, name, std::move(respond));
  } else if (part != "figures" && part != "states.png" && part != "export.glb") {
    return respond(not_found(request.target));
  } else if (!check_method(request, {"GET"}, respond)) {
    return;
  }
  auto question = map_question(request, target, part);
  if (!question) return respond(problem(question.error()));
  ask_map(atlas_, name, std::move(*question), std::move(respond));
}

protocol::Result<Question> Api::map_question(const HttpRequest& request, const Target& target,
                                             const std::string& part) const {
  if (part.empty())
    return [](const RoomPointer& room, Given give) { describe_map(room, 200, std::move(give)); };
  if (part == "figures") return give_figures;
  if (part == "states.png") {
    const auto layer = number(target, "layer", 0);
    if (!layer) return no_number("layer");
    return [layer = *layer, &workers = workers_](const RoomPointer& room, Given give) {
      give_states(room, layer, workers, std::move(give));
    };
  }
  ExportQuestion asked{.seq = {}, .if_none_match = request.if_none_match};
  if (target.asked("seq")) {
    asked.seq = number(target, "seq", 0);
    if (!asked.seq) return no_number("seq");
  }
  return [asked, &workers = workers_](const RoomPointer& room, Given give) {
    give_export(room, asked, workers, std::move(give));
  };
}

}  // namespace earthwork::net
