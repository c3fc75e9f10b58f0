#include "server/app/map_report.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "protocol/chunk_record.hpp"
#include "server/app/answer.hpp"
#include "server/app/stored_map.hpp"
#include "server/app/whole_mesh.hpp"
#include "server/journal/audit.hpp"
#include "server/journal/map_file.hpp"
#include "server/net/map_figures.hpp"

namespace earthwork::app {
namespace {

using journal::DataDirectory;
using nlohmann::ordered_json;
using protocol::Code;
using protocol::hex;

/// Of an event that is there: what reads a map is not told when it is opened that its end is
/// missing.
protocol::Result<std::uint64_t> last_seq_of(const std::filesystem::path& path) {
  const auto opened = journal::open_map_file(path, journal::Access::read);
  if (!opened) return tl::unexpected<protocol::Failure>(opened.error());
  const std::uint64_t last = (*opened)->last_seq();
  if (last > 0)
    if (const auto event = (*opened)->events(last, 1); !event)
      return tl::unexpected<protocol::Failure>(event.error());
  return last;
}

ordered_json listed(const DataDirectory& folder, const std::string& name) {
  const auto path = folder.map_file(name);
  ordered_json line{{"name", name}, {"seq", nullptr}, {"bytes", file_bytes(path)}};
  if (const auto last = last_seq_of(path)) {
    line["seq"] = *last;
    line["state"] = "sound";
  } else {
    line["state"] = protocol::name(last.error().code);
    line["detail"] = last.error().detail;
  }
  return line;
}

ordered_json figures_of(const journal::Restored& restored) {
  const protocol::MapSettings& settings = restored.settings;
  const room::MeshCache meshes = mesh_whole(restored.map, settings, restored.seq);
  return net::write_figures(
      {.seq = restored.seq,
       .hash = restored.hash,
       .chunks = restored.map.chunk_count(),
       .voxel_bytes = restored.map.memory_bytes(),
       .geometry = mesh::count_figures(restored.map, settings.max_feature_angle),
       .meshes = meshes.totals()},
      settings.chunk_resolution);
}

ordered_json described(const StoredMap& stored, const journal::Restored& restored,
                       const std::vector<journal::Keyframe>& keyframes) {
  const journal::Identity& identity = stored.journal->identity();
  const std::uint64_t events = restored.seq;
  const std::uint64_t bytes = file_bytes(stored.path);
  ordered_json seqs = ordered_json::array();
  for (const journal::Keyframe& keyframe : keyframes) seqs.push_back(keyframe.seq);
  return {{"name", stored.name},
          {"settings", protocol::write_settings(restored.settings)},
          {"epoch", hex(identity.epoch)},
          {"created_ms", identity.created_ms},
          {"events", events},
          {"file_bytes", bytes},
          {"bytes_per_event",
           events > 0 ? static_cast<double>(bytes) / static_cast<double>(events) : 0.0},
          {"keyframes", std::move(seqs)}};
}

/// A server also looks at what lies beside the file. To open a sound one for it changes nothing
/// that a server would not.
void try_to_serve(const std::filesystem::path& path, journal::Audit& audit) {
  const auto opened = journal::open_map_file(path, journal::Access::write);
  if (!opened && opened.error().code == Code::damaged) audit.findings.push_back(opened.error());
}

/// Says on stderr what of a damaged map can still be had.
void tell_what_is_left(const StoredMap& stored, const journal::Audit& audit) {
  const std::string command = "map export " + stored.name + " OUT";
  const std::string seq = std::to_string(audit.events);
  warn("the log is good up to seq " + seq + ": " + command + " --seq " + seq + " still gives that");
  const std::uint64_t last = stored.journal->last_seq();
  if (audit.events == last) return;
  if (const auto end = journal::restore(*stored.journal, last, journal::Trust::salvage))
    warn(command + ".glb, or .png, still gives the map of seq " + std::to_string(last) +
         ", from keyframe " + std::to_string(end->keyframe_seq) + " on");
}

int answer_audit(const std::string& name, const journal::Audit& audit) {
  ordered_json findings = ordered_json::array();
  for (const protocol::Failure& finding : audit.findings) {
    warn("damaged: " + finding.detail);
    findings.push_back(finding.detail);
  }
  const int answered = answer({{"name", name},
                               {"events", audit.events},
                               {"hash", hex(audit.hash)},
                               {"keyframes", audit.keyframes},
                               {"sound", audit.sound()},
                               {"findings", std::move(findings)}});
  return audit.sound() ? answered : kFailed;
}

}  // namespace

int list_maps(const MapFlags& flags) {
  const auto folder = DataDirectory::open(flags.data, DataDirectory::Missing::refuse);
  if (!folder) return refuse(folder.error());
  const auto names = (*folder)->map_names();
  if (!names) return refuse(names.error());
  for (const std::string& name : *names)
    if (const int answered = answer(listed(**folder, name)); answered != kDone) return answered;
  return kDone;
}

int show_map(const MapFlags& flags) {
  const auto stored = open_stored_map(flags);
  if (!stored) return refuse(stored.error());
  const auto restored = salvage(*stored, {});
  if (!restored) return refuse(restored.error());
  const auto keyframes = stored->journal->keyframes();
  ordered_json line =
      described(*stored, *restored, keyframes.value_or(std::vector<journal::Keyframe>{}));
  line.update(figures_of(*restored));
  return answer(line);
}

int hash_map(const MapFlags& flags) {
  const auto stored = open_stored_map(flags);
  if (!stored) return refuse(stored.error());
  const auto restored = salvage(*stored, flags.seq);
  if (!restored) return refuse(restored.error());
  return answer({{"seq", restored->seq}, {"hash", hex(restored->hash)}});
}

int verify_map(const MapFlags& flags) {
  auto stored = open_stored_map(flags);
  if (!stored && stored.error().code == Code::damaged) {
    journal::Audit nothing;
    nothing.findings.push_back(stored.error());
    return answer_audit(flags.name, nothing);
  }
  if (!stored) return refuse(stored.error());
  auto audit = journal::audit(*stored->journal);
  if (!audit) return refuse(audit.error());
  if (!audit->sound()) {
    const int damaged = answer_audit(stored->name, *audit);
    tell_what_is_left(*stored, *audit);
    return damaged;
  }
  stored->journal.reset();
  try_to_serve(stored->path, *audit);
  return answer_audit(stored->name, *audit);
}

}  // namespace earthwork::app
