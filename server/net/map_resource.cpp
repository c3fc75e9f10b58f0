#include "server/net/map_resource.hpp"

#include <exception>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

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
std::function<void()> answering(Respond respond, Task task) {
  return [respond = std::move(respond), task = std::move(task)] {
    try {
      task();
    } catch (const std::exception& error) {
      respond(problem({Code::internal, error.what(), {}}));
    }
  };
}

/// Answers with what `make` gives, made by the workers.
void answer_later(Workers& workers, Respond respond, std::function<HttpResponse()> make) {
  const bool taken = workers.offer([respond, make = std::move(make)] {
    try {
      respond(make());
    } catch (const std::exception& error) {  // out of memory, say: this answer's trouble alone
      respond(problem({Code::internal, error.what(), {}}));
    }
  });
  if (!taken) respond(busy());
}

/// Runs `then` on the room's strand as soon as every mesh is up to date there. The work is cut into
/// pieces, so that edits get between; they grow, so that it ends however many edits there are.
void with_meshes(const RoomPointer& room, Respond respond, std::function<void(Room&)> then,
                 std::size_t budget_chunks = 64) {
  auto piece = [room, respond, then = std::move(then), budget_chunks] {
    if (room->refresh_meshes(budget_chunks))
      then(*room);
    else
      with_meshes(room, respond, then, budget_chunks * 2);
  };
  room->strand().post(answering(std::move(respond), std::move(piece)));
}

}  // namespace

void describe_map(const RoomPointer& room, int status, Respond respond) {
  auto describe = [room, status, respond] {
    const room::RoomInfo info = room->info();
    HttpResponse response =
        json_response(status, {{"name", room->name()},
                               {"settings", protocol::write_settings(room->settings())},
                               {"epoch", protocol::hex(room->epoch())},
                               {"seq", info.seq},
                               {"hash", protocol::hex(info.hash)},
                               {"chunks", info.chunks},
                               {"users", info.users}});
    if (status == 201) response.headers.emplace_back("Location", "/api/maps/" + room->name());
    respond(std::move(response));
  };
  room->strand().post(answering(std::move(respond), std::move(describe)));
}

void give_figures(const RoomPointer& room, Respond respond) {
  with_meshes(room, respond, [respond](Room& live) {
    respond(json_response(200, write_figures(live.figures(), live.settings().chunk_resolution)));
  });
}

void give_states(const RoomPointer& room, std::uint64_t layer, Workers& workers, Respond respond) {
  auto draw = [room, layer, &workers, respond] {
    if (workers.full()) return respond(busy());
    auto drawn = room->states(layer);
    if (!drawn) {
      const bool too_large = drawn.error().code == Code::too_large;
      return respond(too_large ? problem(422, drawn.error()) : problem(drawn.error()));
    }
    auto picture = std::make_shared<room::StatesPicture>(std::move(*drawn));
    answer_later(workers, respond, [picture]() -> HttpResponse {
      auto png = encode_png(*picture);
      if (!png) return problem(png.error());
      return {.status = 200, .content_type = "image/png", .headers = {}, .body = std::move(*png)};
    });
  };
  room->strand().post(answering(std::move(respond), std::move(draw)));
}

void give_export(const RoomPointer& room, ExportQuestion question, Workers& workers,
                 Respond respond) {
  auto answer = [room, question = std::move(question), &workers, respond](Room& live) {
    room::MeshSnapshot snapshot = live.meshes();
    if (question.seq && *question.seq != snapshot.seq) {
      return respond(problem(
          {Code::not_supported,
           "seq: only the map as it is now can be exported, seq " + std::to_string(snapshot.seq),
           "seq"}));
    }
    const std::string tag = export_tag(live.settings(), snapshot.mesh_hash);
    if (question.if_none_match && names_tag(*question.if_none_match, tag))
      return respond({.status = 304, .content_type = {}, .headers = {{"ETag", tag}}, .body = {}});

    answer_later(workers, respond, [room, snapshot, tag]() -> HttpResponse {
      auto file = make_glb(room->settings(), snapshot.records);
      if (!file) return problem(422, file.error());
      return {.status = 200,
              .content_type = "model/gltf-binary",
              .headers = {{"ETag", tag}},
              .body = std::move(*file)};
    });
  };
  with_meshes(room, std::move(respond), std::move(answer));
}

}  // namespace earthwork::net
