#include "client/bot/load_command.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>

#include "client/bot/load_report.hpp"
#include "client/bot/load_voxels.hpp"
#include "client/bot/target_map.hpp"
#include "protocol/limits.hpp"

namespace earthwork::bot {
namespace {

using protocol::Code;
using protocol::fail;
using protocol::Failure;

// Their voxel data is reckoned again after the run, in a second or two.
constexpr std::uint64_t kReckonedEdits = 200'000;

// Every connection is an open file.
void raise_file_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  static_cast<void>(setrlimit(RLIMIT_NOFILE, &limit));
}

protocol::Result<void> check_square(const LoadPlan& plan, const protocol::MapSettings& settings) {
  const double reach = 2 * settings.voxel_size + plan.radius;
  const PaintedSquare& square = plan.square;
  const protocol::MapRect rect{.x0 = square.x0 - reach,
                               .y0 = square.y0 - reach,
                               .x1 = square.x0 + square.side + reach,
                               .y1 = square.y0 + square.side + reach};
  const std::uint64_t chunks = protocol::chunks_of_cells(rect, settings).count();
  if (chunks <= protocol::kMaxViewChunks) return {};
  return fail(Code::too_large,
              "area: " + std::to_string(chunks) + " chunks are beyond the " +
                  std::to_string(protocol::kMaxViewChunks) + " of a view",
              "area");
}

}  // namespace

protocol::Result<LoadPlan> plan_load(const LoadOptions& options,
                                     const protocol::MapSettings& settings) {
  if (options.slow + options.stalled + options.flaky > options.viewers)
    return fail(Code::out_of_range,
                "viewers: " + std::to_string(options.viewers) +
                    " are fewer than those slow, stalled and flaky together",
                "viewers");
  LoadPlan plan{.server = {},
                .map = options.map,
                .editors = options.editors,
                .viewers = options.viewers,
                .slow = options.slow,
                .stalled = options.stalled,
                .flaky = options.flaky,
                .seconds = options.seconds,
                .edits_per_second = options.rate,
                .square = painted_square(settings, options.area),
                .radius = options.radius,
                .threads = options.threads,
                .seed = options.seed};
  const protocol::Edit first = BrushWalk(plan.square, plan.radius, plan.seed).next();
  if (const auto checked = protocol::check_edit(first, settings); !checked)
    return tl::unexpected<Failure>(checked.error());
  if (const auto checked = check_square(plan, settings); !checked)
    return tl::unexpected<Failure>(checked.error());
  return plan;
}

ExitCode load_command(const LoadOptions& options, std::ostream& out, std::ostream& log) {
  const auto server = link::parse_server(options.server);
  if (!server) return log << server.error().detail << '\n', kUsage;
  const auto map = options.create ? make_map(*server, options.map, protocol::MapSettings{})
                                  : link::map_info(*server, options.map);
  if (!map) return log << map.error().detail << '\n', kUsage;
  auto plan = plan_load(options, map->settings);
  if (!plan) return log << plan.error().detail << '\n', kUsage;
  plan->server = *server;

  raise_file_limit();
  const LoadReport report = run_load(*plan, log);
  const ExitCode code = exit_code(report);
  if (code == kUsage) return code;
  const double voxel_bytes =
      mean_voxel_bytes(map->settings, plan->square, plan->radius, plan->seed, plan->editors,
                       std::min(report.acked, kReckonedEdits));
  out << write_report(*plan, report, voxel_bytes).dump() << std::endl;
  if (report.generator_limited())
    log << "the generator was busy or late itself: the figures are partly its own\n";
  if (report.painted && !report.all_agree()) log << "not every viewer agrees with the server\n";
  return code;
}

}  // namespace earthwork::bot
