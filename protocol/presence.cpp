// What people see of each other: users, cursors, brushes.
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "protocol/message_fields.hpp"
#include "protocol/presence_fields.hpp"

namespace earthwork::protocol {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// More do not fit into a message: each has at least a session.
constexpr std::size_t kMostListed = kMaxServerControlBytes / kSessionDigits;

/// The elements of an array of objects, each read by `read` from its fields.
template <class T>
std::vector<T> read_list(JsonFields& in, const char* key, Result<T> (*read)(JsonFields)) {
  std::vector<T> out;
  const json* array = in.array(key, 0, kMostListed);
  if (!array) return out;
  for (const json& element : *array) {
    auto item = read(JsonFields(element, in.path(key) + "[" + std::to_string(out.size()) + "]"));
    if (!item) {
      in.refuse(std::move(item.error()));
      break;
    }
    out.push_back(std::move(*item));
  }
  return out;
}

Result<User> read_user(JsonFields in) {
  User user{.session = in.hex_digits("session", kSessionDigits),
            .name = in.name("name"),
            .color = in.color("color"),
            .author = in.hex_digits("author", kAuthorDigits)};
  return in.result(std::move(user));
}

Result<UserCursor> read_user_cursor(JsonFields in) {
  UserCursor cursor{.session = in.hex_digits("session", kSessionDigits),
                    .at = read_place(in),
                    .brush = read_brush(in),
                    .view = read_seen(in)};
  return in.result(std::move(cursor));
}

Result<Brush> read_brush_fields(JsonFields in) {
  Brush brush;
  brush.stencil = read_stencil(in);
  brush.radius = in.number("radius");
  if (brush.radius < 0) in.refuse(Code::out_of_range, "radius", "is below 0");
  brush.fill = in.boolean("fill");
  if (in.has("layer"))
    brush.layer = static_cast<std::uint32_t>(in.integer("layer", {0, kMaxLayers - 1}));
  return in.result(brush);
}

}  // namespace

std::optional<MapPoint> read_place(JsonFields& in) {
  if (in.has("hidden") && in.boolean("hidden")) {
    if (in.has("x") || in.has("y"))
      in.refuse(Code::bad_field, "hidden", "does not go with x and y");
    return std::nullopt;
  }
  return MapPoint{.x = in.number("x"), .y = in.number("y")};
}

void write_place(const std::optional<MapPoint>& at, ordered_json& out) {
  if (at) {
    out["x"] = at->x;
    out["y"] = at->y;
  } else {
    out["hidden"] = true;
  }
}

std::optional<Brush> read_brush(JsonFields& in) {
  const json* object = in.has("brush") ? in.value("brush") : nullptr;
  if (!object) return std::nullopt;
  auto brush = read_brush_fields(JsonFields(*object, in.path("brush")));
  if (brush) return *brush;
  in.refuse(std::move(brush.error()));
  return std::nullopt;
}

void write_brush(const std::optional<Brush>& brush, ordered_json& out) {
  if (!brush) return;
  ordered_json& fields = out["brush"];
  fields["stencil"] = name(brush->stencil);
  fields["radius"] = brush->radius;
  fields["fill"] = brush->fill;
  if (brush->layer != 0) fields["layer"] = brush->layer;
}

MapRect read_rect(JsonFields& in, const char* key) {
  const auto r = in.numbers(key, 4);
  if (!in.failed() && !(r[0] <= r[2] && r[1] <= r[3]))
    in.refuse(Code::out_of_range, key, "[x0, y0, x1, y1] needs x0 <= x1 and y0 <= y1");
  return {r[0], r[1], r[2], r[3]};
}

ordered_json write_rect(const MapRect& rect) { return {rect.x0, rect.y0, rect.x1, rect.y1}; }

std::optional<MapRect> read_seen(JsonFields& in) {
  if (!in.has("view")) return std::nullopt;
  return read_rect(in, "view");
}

void write_seen(const std::optional<MapRect>& view, ordered_json& out) {
  if (view) out["view"] = write_rect(*view);
}

std::vector<User> read_users(JsonFields& in) { return read_list<User>(in, "users", read_user); }

ordered_json write_users(const std::vector<User>& users) {
  auto out = ordered_json::array();
  for (const User& user : users)
    out.push_back({{"session", user.session},
                   {"name", user.name},
                   {"color", user.color},
                   {"author", user.author}});
  return out;
}

Result<ServerMessage> read_presence(JsonFields& in) {
  Presence presence;
  presence.all = in.has("all") && in.boolean("all");
  if (in.has("users")) presence.users = read_users(in);
  if (in.has("left")) presence.left = in.hex_list("left", kSessionDigits, kMostListed);
  if (in.has("cursors")) presence.cursors = read_list<UserCursor>(in, "cursors", read_user_cursor);
  return in.result<ServerMessage>(std::move(presence));
}

void write_presence(const Presence& presence, ordered_json& out) {
  if (presence.all) out["all"] = true;
  if (!presence.users.empty()) out["users"] = write_users(presence.users);
  if (!presence.left.empty()) out["left"] = presence.left;
  if (presence.cursors.empty()) return;
  auto& cursors = out["cursors"] = ordered_json::array();
  for (const UserCursor& cursor : presence.cursors) {
    ordered_json one{{"session", cursor.session}};
    write_place(cursor.at, one);
    write_brush(cursor.brush, one);
    write_seen(cursor.view, one);
    cursors.push_back(std::move(one));
  }
}

}  // namespace earthwork::protocol
