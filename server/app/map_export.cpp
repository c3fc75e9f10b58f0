#include "server/app/map_export.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "protocol/chunk_record.hpp"
#include "server/app/answer.hpp"
#include "server/app/recorded_events.hpp"
#include "server/app/stored_map.hpp"
#include "server/app/whole_mesh.hpp"
#include "server/journal/event_pages.hpp"
#include "server/net/glb_export.hpp"
#include "server/net/png.hpp"
#include "server/room/states_picture.hpp"

namespace earthwork::app {
namespace {

using protocol::Code;
using protocol::Failure;
using protocol::Result;

enum class Format { glb, png, recording };

std::optional<Format> format_of(const std::string& file) {
  if (file.ends_with(".glb")) return Format::glb;
  if (file.ends_with(".png")) return Format::png;
  if (file.ends_with(".jsonl")) return Format::recording;
  return std::nullopt;
}

/// What the file shows.
struct Shown {
  std::uint64_t seq = 0, hash = 0;
};

Result<Shown> export_recording(journal::Journal& journal, const MapFlags& flags, NewFile& out) {
  const std::uint64_t last = journal.last_seq();
  const std::uint64_t seq = flags.seq.value_or(last);
  if (seq > last)
    return protocol::fail(
        Code::out_of_range,
        "seq: " + std::to_string(seq) + " is beyond the last one, " + std::to_string(last));
  return write_recording(journal, seq, out).map([seq](std::uint64_t hash) {
    return Shown{seq, hash};
  });
}

Result<Shown> export_bytes(const StoredMap& stored, Format format, const MapFlags& flags,
                           NewFile& out) {
  const auto restored = salvage(stored, flags.seq);
  if (!restored) return tl::unexpected<Failure>(restored.error());
  const auto bytes =
      format == Format::glb ? glb_of(*restored) : png_of(*restored, flags.layer.value_or(0));
  if (!bytes) return tl::unexpected<Failure>(bytes.error());
  return out.write(*bytes).map([&restored] { return Shown{restored->seq, restored->hash}; });
}

}  // namespace

Result<std::string> glb_of(const journal::Restored& restored) {
  const auto meshes = mesh_whole(restored.map, restored.settings, restored.seq);
  return net::make_glb(restored.settings, meshes.records());
}

Result<std::string> png_of(const journal::Restored& restored, std::uint64_t layer) {
  return room::draw_states(restored.map, layer).and_then(net::encode_png);
}

Result<std::uint64_t> write_recording(journal::Journal& journal, std::uint64_t seq, NewFile& out) {
  const journal::Identity& identity = journal.identity();
  if (auto written =
          out.write(write(protocol::RecordingHead{identity.settings, identity.epoch}) + "\n");
      !written)
    return tl::unexpected<Failure>(std::move(written.error()));
  std::uint64_t hash = 0;
  auto told = journal::read_events(journal, 0, seq, [&](const history::Event& event) {
    hash = event.hash;
    return out.write(write(to_recorded(event)) + "\n");
  });
  if (!told) return tl::unexpected<Failure>(std::move(told.error()));
  return hash;
}

int export_map(const MapFlags& flags) {
  const auto format = format_of(flags.file);
  if (!format) return refuse(kUsage, flags.file + ": ends with none of .glb, .png, .jsonl");
  if (flags.layer && *format != Format::png)
    return refuse(kUsage, "--layer: only a .png shows a single layer");
  const auto stored = open_stored_map(flags);
  if (!stored) return refuse(stored.error());

  NewFile out(flags.file);
  const auto shown = *format == Format::recording ? export_recording(*stored->journal, flags, out)
                                                  : export_bytes(*stored, *format, flags, out);
  if (!shown) return refuse(shown.error());
  if (const auto finished = out.finish(); !finished) return refuse(finished.error());
  return answer({{"name", stored->name},
                 {"file", flags.file},
                 {"bytes", out.bytes()},
                 {"seq", shown->seq},
                 {"hash", protocol::hex(shown->hash)}});
}

}  // namespace earthwork::app
