/// What is said of people, in messages of both sides: who they are, where they point, and with
/// which brush.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "protocol/json_fields.hpp"
#include "protocol/messages.hpp"

namespace earthwork::protocol {

/// x and y, or in place of them "hidden": true, which is no place.
std::optional<MapPoint> read_place(JsonFields& in);
void write_place(const std::optional<MapPoint>& at, nlohmann::ordered_json& out);

/// "brush": {stencil, radius, fill, layer?}; nothing when it is missing.
std::optional<Brush> read_brush(JsonFields& in);
void write_brush(const std::optional<Brush>& brush, nlohmann::ordered_json& out);

/// A field [x0, y0, x1, y1] with x0 <= x1 and y0 <= y1.
MapRect read_rect(JsonFields& in, const char* key);
[[nodiscard]] nlohmann::ordered_json write_rect(const MapRect& rect);

/// "view": the part of the map that somebody sees; nothing when it is missing.
std::optional<MapRect> read_seen(JsonFields& in);
void write_seen(const std::optional<MapRect>& view, nlohmann::ordered_json& out);

/// The array "users".
std::vector<User> read_users(JsonFields& in);
[[nodiscard]] nlohmann::ordered_json write_users(const std::vector<User>& users);

[[nodiscard]] Result<ServerMessage> read_presence(JsonFields& in);
void write_presence(const Presence& presence, nlohmann::ordered_json& out);

}  // namespace earthwork::protocol
