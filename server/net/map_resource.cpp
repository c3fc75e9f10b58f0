#include "server/net/map_resource.hpp"

#include <exception>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "server/net/entity_tag.hpp"
#include "server/net/glb_export.hpp"
#include "server/net/map_figures.hpp"
#include "server/net/png.hpp"

namespace earthwork::net {
namespace {

using protocol::Code;
using room::Room;

HttpResponse busy() {
  HttpResponse response =
      problem(503, {Code::too_large, "too many exports and pictures are being made", {}});
  response.headers.emplace_back("Retry-After", "1");
  return response;
}

/// A task for a room's strand that answers; when it throws, the answer is that it did.
template <class Task>
std::function<void()> answering(Given give, Task task) {
  return [give = std::move(give), task = std::move(task)] {
    try {
      task();
    } catch (const std::exception& error) {
      give(problem({Code::internal, error.what(), {}}));
    }
  };
}

/// Answers with what `make` gives, made by the workers.
void answer_later(Workers& workers, Given give, std::function<HttpResponse()> make) {
  const bool taken = workers.offer([give, make = std::move(make)] {
    try {
      give(make());
    } catch (const std::exception& error) {  // out of memory, say: this answer's trouble alone
      give(problem({Code::internal, error.what(), {}}));
    }
  });
  if (!taken) give(busy());
}

/// Runs `then` on the room's strand as soon as every mesh is up to date there. The work is cut into
/// pieces, so that edits get between; they grow, so that it ends however many edits there are.
void with_meshes(const RoomPointer& room, Given give, std::function<void(Room&)> then,
                 std::size_t budget_chunks = 64) {
  auto piece = [room, give, then = std::move(then), budget_chunks] {
    if (room->closed()) return give(std::nullopt);
    if (room->refresh_meshes(budget_chunks))
      then(*room);
    else  // the meshes of what viewers wait for come first
      room->once_durable([room, give, then, budget_chunks](bool) {
        with_meshes(room, give, then, budget_chunks * 2);
      });
  };
  room->strand().post(answering(std::move(give), std::move(piece)));
}

/// Runs `then` on the room's strand once all that the room shows now is stored. When it is taken
/// back instead nothing is given.
void when_kept(Room& room, Given give, std::function<void()> then) {
  room.once_durable([give, then = answering(give, std::move(then))](bool kept) {
    if (kept)
      then();
    else
      give(std::nullopt);
  });
}

void give_when_kept(Room& room, const Given& give, HttpResponse response) {
  when_kept(room, give, [give, response = std::move(response)] { give(response); });
}

}  // namespace

void describe_map(const RoomPointer& room, int status, Given give) {
  auto describe = [room, status, give] {
    const room::RoomInfo info = room->info();
    HttpResponse response =
        json_response(status, {{"name", room->name()},
                               {"settings", protocol::write_settings(info.settings)},
                               {"epoch", protocol::hex(room->epoch())},
                               {"seq", info.seq},
                               {"hash", protocol::hex(info.hash)},
                               {"chunks", info.chunks},
                               {"users", info.users}});
    if (status == 201) response.headers.emplace_back("Location", "/api/maps/" + room->name());
    give(std::move(response));  // what a room says of itself is stored
  };
  room->strand().post(answering(std::move(give), std::move(describe)));
}

void give_figures(const RoomPointer& room, Given give) {
  with_meshes(room, give, [give](Room& live) {
    const int resolution = live.settings().chunk_resolution;
    give_when_kept(live, give, json_response(200, write_figures(live.figures(), resolution)));
  });
}

void give_states(const RoomPointer& room, std::uint64_t layer, Workers& workers, Given give) {
  auto draw = [room, layer, &workers, give] {
    if (workers.full()) return give(busy());
    auto drawn = room->states(layer);
    if (!drawn) {
      const bool too_large = drawn.error().code == Code::too_large;
      return give_when_kept(*room, give,
                            too_large ? problem(422, drawn.error()) : problem(drawn.error()));
    }
    auto encode = [picture =
                       std::make_shared<room::StatesPicture>(std::move(*drawn))]() -> HttpResponse {
      auto png = encode_png(*picture);
      if (!png) return problem(png.error());
      return {.status = 200, .content_type = "image/png", .headers = {}, .body = std::move(*png)};
    };
    when_kept(*room, give, [&workers, give, encode] { answer_later(workers, give, encode); });
  };
  room->strand().post(answering(std::move(give), std::move(draw)));
}

void give_export(const RoomPointer& room, ExportQuestion question, Workers& workers, Given give) {
  auto answer = [question = std::move(question), &workers, give](Room& live) {
    auto snapshot = std::make_shared<room::MeshSnapshot>(live.meshes());
    if (question.seq && *question.seq != snapshot->seq) {
      return give_when_kept(live, give,
                            problem({Code::not_supported,
                                     "seq: only the map as it is now can be exported, seq " +
                                         std::to_string(snapshot->seq),
                                     "seq"}));
    }
    const std::string tag = export_tag(snapshot->settings, snapshot->mesh_hash);
    if (question.if_none_match && names_tag(*question.if_none_match, tag))
      return give_when_kept(
          live, give, {.status = 304, .content_type = {}, .headers = {{"ETag", tag}}, .body = {}});

    auto encode = [snapshot, tag]() -> HttpResponse {
      auto file = make_glb(snapshot->settings, snapshot->records);
      if (!file) return problem(422, file.error());
      return {.status = 200,
              .content_type = "model/gltf-binary",
              .headers = {{"ETag", tag}},
              .body = std::move(*file)};
    };
    when_kept(live, give, [&workers, give, encode] { answer_later(workers, give, encode); });
  };
  with_meshes(room, std::move(give), std::move(answer));
}

}  // namespace earthwork::net
