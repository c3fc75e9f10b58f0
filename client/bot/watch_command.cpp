#include "client/bot/watch_command.hpp"

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>

#include "client/bot/watcher.hpp"
#include "protocol/gltf/glb.hpp"

namespace earthwork::bot {
namespace {

std::string figures(const scene::Scene& scene) {
  const nlohmann::ordered_json line{{"seq", scene.seq()},
                                    {"frames", scene.stats().frames},
                                    {"bytes", scene.stats().bytes},
                                    {"chunks", scene.stats().chunks},
                                    {"mesh_hash", protocol::hex(scene.mesh_hash())}};
  return line.dump();
}

protocol::Result<void> save_glb(const WatchReport& report, const std::string& path) {
  protocol::MeshMap meshes;
  for (const auto& [key, chunk] : report.scene.chunks()) meshes.emplace(key, &chunk.mesh);
  const auto bytes = protocol::write_glb(report.settings, meshes);
  if (!bytes) return tl::unexpected<protocol::Failure>(bytes.error());
  std::ofstream file(path, std::ios::binary);
  file.write(bytes->data(), static_cast<std::streamsize>(bytes->size()));
  file.close();
  if (file) return {};
  return protocol::fail(protocol::Code::internal, "'" + path + "' cannot be written", "glb");
}

ExitCode finish(const WatchReport& report, const WatchCommandOptions& options, std::ostream& log) {
  if (options.until_seq && report.scene.seq() < *options.until_seq)
    log << "seq " << *options.until_seq << " was not reached, only " << report.scene.seq() << '\n';
  if (!report.scene.complete_view()) {
    log << "not all of the map arrived\n";
    return kFailed;
  }
  if (options.glb) {
    if (const auto saved = save_glb(report, *options.glb); !saved) {
      log << saved.error().detail << '\n';
      return kFailed;
    }
  }
  return report.complete && !report.broken ? kDone : kFailed;
}

}  // namespace

ExitCode watch_command(const WatchCommandOptions& options, std::ostream& out, std::ostream& log) {
  const auto server = link::parse_server(options.server);
  if (!server) return log << server.error().detail << '\n', kUsage;
  if (!protocol::valid_map_name(options.map))
    return log << "map: '" << options.map << "' is no map's name: 1-64 of a-z, 0-9, '-', '_'\n",
           kUsage;
  WatchOptions watching{.server = *server,
                        .map = options.map,
                        .until_seq = options.until_seq,
                        .time_limit = {},
                        .patience = options.patience};
  if (options.seconds)
    watching.time_limit = std::chrono::duration_cast<std::chrono::nanoseconds>(
        std::chrono::duration<double>(*options.seconds));

  const WatchReport report = watch(watching, log);
  if (report.broken && !report.joined) return kUsage;
  out << figures(report.scene) << std::endl;
  return finish(report, options, log);
}

}  // namespace earthwork::bot
