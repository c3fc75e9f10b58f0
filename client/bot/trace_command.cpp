#include "client/bot/trace_command.hpp"

#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "client/bot/paint_report.hpp"
#include "client/bot/painter.hpp"
#include "client/bot/target_map.hpp"
#include "client/bot/trace_plan.hpp"

namespace earthwork::bot {
namespace {

using protocol::Failure;

protocol::Result<link::MapInfo> prepare(const TraceOptions& options,
                                        const link::ServerAddress& server, const Bitmap& picture) {
  auto map = options.create
                 ? make_map(server, options.map, settings_for(picture, options.resolution))
                 : link::map_info(server, options.map);
  if (!map) return map;
  if (const auto fits = check_fits(picture, map->settings); !fits)
    return tl::unexpected<Failure>(fits.error());
  return map;
}

std::uint64_t count_stamps(const std::vector<protocol::Edit>& edits) {
  std::uint64_t count = 0;
  for (const protocol::Edit& edit : edits) count += edit.path.size();
  return count;
}

}  // namespace

protocol::MapSettings settings_for(const Bitmap& picture, int resolution) {
  const auto chunks = [&](int voxels) { return (voxels + resolution - 1) / resolution; };
  protocol::MapSettings settings;
  settings.chunk_resolution = resolution;
  settings.chunks = {0, 0, chunks(picture.width()), chunks(picture.height())};
  return settings;
}

protocol::Result<void> check_fits(const Bitmap& picture, const protocol::MapSettings& settings) {
  if (!settings.chunks) return {};
  const auto& [x0, y0, x1, y1] = *settings.chunks;
  const std::int64_t side = settings.chunk_resolution;
  if (x0 <= 0 && y0 <= 0 && x1 * side >= picture.width() && y1 * side >= picture.height())
    return {};
  return protocol::fail(protocol::Code::out_of_range,
                        "image: its " + std::to_string(picture.width()) + " x " +
                            std::to_string(picture.height()) +
                            " pixels, from voxel (0, 0) on, reach beyond the map's bounds",
                        "image");
}

ExitCode trace_command(const TraceOptions& options, std::ostream& out, std::ostream& log) {
  const auto server = link::parse_server(options.server);
  if (!server) return log << server.error().detail << '\n', kUsage;
  const auto picture = read_png(options.image, options.threshold, options.ink);
  if (!picture) return log << picture.error().detail << '\n', kUsage;
  const auto map = prepare(options, *server, *picture);
  if (!map) return log << map.error().detail << '\n', kUsage;

  const Ground ground = map->seq == 0 ? Ground::empty : Ground::unknown;
  const auto edits = plan_trace(*picture, ground, map->settings);
  const std::vector<protocol::ScriptStep> steps(edits.begin(), edits.end());
  const PaintReport report = paint(
      {.server = *server, .map = options.map, .edits_per_second = {}, .patience = options.patience},
      steps, log);
  const ExitCode code = exit_code(report);
  if (code == kUsage) return code;
  auto line = write_report(report);
  line["stamps"] = count_stamps(edits);
  line["pixels"] = picture->size();
  out << line.dump() << std::endl;
  return code;
}

}  // namespace earthwork::bot
