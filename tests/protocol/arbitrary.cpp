#include "tests/protocol/arbitrary.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "protocol/limits.hpp"

namespace earthwork::protocol {
namespace {

using rc::gen::inRange;

std::string digits(std::size_t count, std::string_view alphabet) {
  std::string text(count, ' ');
  for (char& c : text) c = alphabet[*inRange<std::size_t>(0, alphabet.size())];
  return text;
}

std::string hex_text(std::size_t count) { return digits(count, "0123456789abcdef"); }
std::string color() { return "#" + hex_text(6); }
std::string map_name() {
  return digits(*inRange<std::size_t>(1, 65), "abcdefghijklmnopqrstuvwxyz0123456789-_");
}

std::string person() {
  static const std::vector<std::string> kCharacters = {"a", "Z", " ", "\"", "\\", "é", "水", "🌍"};
  std::string name;
  for (auto left = *inRange(1, 65); left > 0; --left) name += *rc::gen::elementOf(kCharacters);
  return name;
}

double real() {
  return static_cast<double>(*inRange<std::int64_t>(-kMaxInteger, kMaxInteger)) /
         std::pow(2.0, *inRange(0, 60));
}

std::uint64_t seq() { return static_cast<std::uint64_t>(*inRange<std::int64_t>(0, kMaxInteger)); }
MessageId id() { return *inRange<MessageId>(1, kMaxInteger); }
std::optional<MessageId> maybe_id() {
  if (*inRange(0, 2) == 0) return std::nullopt;
  return id();
}

MapRect rect() {
  const double a = real(), b = real(), c = real(), d = real();
  return {std::min(a, b), std::min(c, d), std::max(a, b), std::max(c, d)};
}

Hello hello() {
  Hello hello;
  hello.protocol_min = *inRange(1, 65536);
  hello.protocol_max = *inRange(hello.protocol_min, 65536);
  hello.name = person();
  if (*inRange(0, 2)) hello.color = color();
  if (*inRange(0, 2)) hello.key = hex_text(32);
  hello.id = maybe_id();
  return hello;
}

View view() {
  View view;
  view.n = *inRange<std::uint32_t>(0, UINT32_MAX);
  if (*inRange(0, 2)) view.rect = rect();
  if (*inRange(0, 2)) view.have = Have{hex_text(16), seq(), rect()};
  view.id = maybe_id();
  return view;
}

Join join() {
  Join join;
  join.map = map_name();
  if (*inRange(0, 2)) join.seq = seq();
  join.id = maybe_id();
  return join;
}

User user() { return {hex_text(16), person(), color(), hex_text(16)}; }

Joined joined() {
  Joined joined;
  joined.map = map_name();
  joined.settings = *any_settings();
  joined.epoch = hex_text(16);
  joined.seq = seq();
  for (auto left = *inRange(0, 4); left > 0; --left) joined.users.push_back(user());
  joined.id = maybe_id();
  return joined;
}

std::optional<MapPoint> maybe_point() {
  if (*inRange(0, 4) == 0) return std::nullopt;
  return MapPoint{real(), real()};
}

std::optional<Brush> maybe_brush() {
  if (*inRange(0, 2) == 0) return std::nullopt;
  return Brush{.stencil = *rc::gen::element(StencilShape::square, StencilShape::circle),
               .radius = std::abs(real()),
               .fill = *inRange(0, 2) == 1,
               .layer = *inRange(0u, 16u)};
}

std::optional<MapRect> maybe_rect() {
  if (*inRange(0, 2) == 0) return std::nullopt;
  return rect();
}

Presence presence() {
  Presence presence{.all = *inRange(0, 2) == 1, .users = {}, .left = {}, .cursors = {}};
  for (auto n = *inRange(0, 4); n > 0; --n) presence.users.push_back(user());
  for (auto n = *inRange(0, 4); n > 0; --n) presence.left.push_back(hex_text(16));
  for (auto n = *inRange(0, 4); n > 0; --n)
    presence.cursors.push_back({hex_text(16), maybe_point(), maybe_brush(), maybe_rect()});
  return presence;
}

Event event() {
  return {.seq = seq() + 1,
          .time_ms = *inRange<std::int64_t>(-kMaxInteger, kMaxInteger),
          .author = hex_text(16),
          .action = *any_action(),
          .hash = hex_text(16)};
}

SettingsChanged settings_changed() { return {.seq = seq() + 1, .settings = *any_settings()}; }

Failure failure() {
  Failure failure;
  failure.code = static_cast<Code>(*inRange(0, static_cast<int>(Code::internal) + 1));
  failure.detail = person();
  if (*inRange(0, 2)) failure.field = map_name();
  return failure;
}

Bye bye() {
  Bye bye{failure(), {}};
  if (*inRange(0, 2)) bye.retry_after_ms = *inRange<std::uint32_t>(0, UINT32_MAX);
  return bye;
}

MeshNormal normal() {
  const double angle = *inRange(0, 1'000'000) * 6.283185307179586e-6;
  return {static_cast<std::int16_t>(std::lround(32767 * std::cos(angle))),
          static_cast<std::int16_t>(std::lround(32767 * std::sin(angle)))};
}

void add_triangle(ChunkMesh& mesh, const rc::Gen<std::uint16_t>& index) {
  const std::uint16_t a = *index, b = *index, c = *index;
  if (a != b && b != c && c != a) mesh.triangles.insert(mesh.triangles.end(), {a, b, c});
}

void add_section(ChunkMesh& mesh, const rc::Gen<std::uint16_t>& index) {
  const bool goes_on = !mesh.sections.empty() && *inRange(0, 4) > 0;
  WallSection section{*index, *index, normal(), normal()};
  if (goes_on) section.a = mesh.sections.back().b;
  if (goes_on && *inRange(0, 2)) section.normal_a = mesh.sections.back().normal_b;
  if (*inRange(0, 2)) section.normal_b = section.normal_a;
  if (section.a != section.b) mesh.sections.push_back(section);
}

}  // namespace

rc::Gen<MapSettings> any_settings() {
  return rc::gen::exec([] {
    MapSettings settings;
    settings.chunk_resolution = *rc::gen::element(8, 16, 32, 64);
    if (*inRange(0, 2)) {
      const int x = *inRange(-15000, 15000), y = *inRange(-15000, 15000);
      settings.chunks = {x, y, x + *inRange(1, 600), y + *inRange(1, 600)};
    }
    settings.voxel_size = *inRange(1, 1'000'000) / 1024.0;
    settings.max_feature_angle = *inRange(1, 176) - 0.5;
    settings.layers.clear();
    for (auto left = *inRange(1, 17); left > 0; --left) {
      const double bottom = *inRange(-1000, 1000) / 8.0;
      settings.layers.push_back({person(), color(), bottom, bottom + *inRange(1, 100) / 8.0});
    }
    return settings;
  });
}

rc::Gen<Edit> any_edit() {
  return rc::gen::exec([] {
    Edit edit;
    edit.layer = *inRange(0u, 16u);
    edit.stencil = *rc::gen::element(StencilShape::square, StencilShape::circle);
    edit.fill = *inRange(0, 2);
    edit.radius = std::abs(real());
    edit.is_path = *inRange(0, 2);
    for (auto left = edit.is_path ? *inRange(1, 20) : 1; left > 0; --left)
      edit.path.push_back({real(), real()});
    if (*inRange(0, 2)) edit.stroke = *inRange<std::int64_t>(-kMaxInteger, kMaxInteger);
    return edit;
  });
}

rc::Gen<LayerChange> any_layer_change() {
  return rc::gen::exec([] {
    LayerChange change;
    if (*inRange(0, 2)) change.layer = *inRange(0u, 16u);
    if (*inRange(0, 2)) change.name = person();
    if (*inRange(0, 2)) change.wall = {{-*inRange(0, 100) / 8.0, *inRange(1, 100) / 8.0}};
    // Of a layer that is there something is said.
    if (*inRange(0, 2) || (change.layer && !change.name && !change.wall)) change.color = color();
    return change;
  });
}

rc::Gen<Action> any_action() {
  return rc::gen::exec([]() -> Action {
    if (*inRange(0, 3) == 0) return *any_layer_change();
    return *any_edit();
  });
}

rc::Gen<ClientMessage> any_client_message() {
  return rc::gen::exec([]() -> ClientMessage {
    switch (*inRange(0, 11)) {
      case 0:
        return hello();
      case 1:
        return join();
      case 2:
        return Leave{maybe_id()};
      case 3:
        return view();
      case 4:
        return EditMessage{id(), *any_edit()};
      case 5:
        return Undo{id()};
      case 6:
        return Redo{id()};
      case 7:
        return Cursor{maybe_point(), maybe_brush(), maybe_rect(), maybe_id()};
      case 8:
        return Events{seq() + 1, maybe_id()};
      case 9:
        return LayerMessage{id(), *any_layer_change()};
      default:
        return Ping{maybe_id()};
    }
  });
}

rc::Gen<ServerMessage> any_server_message() {
  return rc::gen::exec([]() -> ServerMessage {
    switch (*inRange(0, 10)) {
      case 0:
        return Welcome{hex_text(16), hex_text(32), *inRange(1, 65536), maybe_id()};
      case 1:
        return joined();
      case 2:
        return Applied{id(), seq()};
      case 3:
        return Rejected{maybe_id(), failure()};
      case 4:
        return CaughtUp{*inRange<std::uint32_t>(0, UINT32_MAX), seq()};
      case 5:
        return Done{id()};
      case 6:
        return presence();
      case 7:
        return event();
      case 8:
        return settings_changed();
      default:
        return bye();
    }
  });
}

rc::Gen<ChunkMesh> any_mesh(std::size_t max_vertices) {
  return rc::gen::exec([max_vertices] {
    ChunkMesh mesh;
    const std::size_t vertices = *inRange<std::size_t>(0, max_vertices + 1);
    // Drawing each number from the generator is too slow for thousands of them.
    std::uint64_t state = *rc::gen::arbitrary<std::uint64_t>();
    const auto next = [&state] { return (state = state * 6364136223846793005u + 1442695) >> 33; };
    const auto coordinate = [&] {
      return static_cast<std::int32_t>(next() % static_cast<std::uint64_t>(kMeshCoordinateEnd));
    };
    for (std::size_t i = 0; i < vertices; ++i)
      mesh.vertices.push_back({coordinate(), coordinate()});
    if (vertices < 3) return mesh;
    const auto index = inRange<std::uint16_t>(0, static_cast<std::uint16_t>(vertices));
    for (auto left = *inRange(0, 30); left > 0; --left) add_triangle(mesh, index);
    for (auto left = *inRange(0, 30); left > 0; --left) add_section(mesh, index);
    return mesh;
  });
}

rc::Gen<ChunkRecord> any_record(std::size_t max_vertices) {
  return rc::gen::exec([max_vertices] {
    const auto at = inRange(-kMaxChunkCoordinate, kMaxChunkCoordinate + 1);
    ChunkRecord record;
    record.key = {*inRange(0, 16), *at, *at, *at};
    record.revision = *rc::gen::arbitrary<std::uint64_t>();
    record.removed = *inRange(0, 4) == 0;
    if (!record.removed) record.mesh = *any_mesh(max_vertices);
    return record;
  });
}

}  // namespace earthwork::protocol
