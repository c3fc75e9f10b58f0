#include "client/bot/run_command.hpp"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <utility>

#include "client/bot/paint_report.hpp"
#include "client/bot/painter.hpp"
#include "client/bot/target_map.hpp"
#include "protocol/script.hpp"

namespace earthwork::bot {
namespace {

using protocol::Code;
using protocol::Failure;

protocol::Result<std::string> read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const auto refuse = [&](const std::string& why) {
    return protocol::fail(Code::bad_field, "script: '" + path + "' " + why, "script");
  };
  if (!file || std::filesystem::is_directory(path)) return refuse("cannot be read");
  std::string text;
  while (file && text.size() <= kMaxScriptBytes) {
    constexpr std::size_t kPiece = 64 * 1024;
    const std::size_t before = text.size();
    text.resize(before + kPiece);
    file.read(text.data() + before, kPiece);
    text.resize(before + static_cast<std::size_t>(file.gcount()));
  }
  if (text.size() > kMaxScriptBytes)
    return refuse("is longer than " + std::to_string(kMaxScriptBytes) + " bytes");
  return text;
}

protocol::Result<protocol::Script> load(const std::string& path) {
  const auto text = read_file(path);
  if (!text) return tl::unexpected<Failure>(text.error());
  auto script = protocol::read_script(*text);
  if (!script) script.error().detail = path + ": " + script.error().detail;
  return script;
}

/// The map as it is before the first edit.
protocol::Result<link::MapInfo> prepare(const RunOptions& options,
                                        const link::ServerAddress& server,
                                        const protocol::Script& script) {
  if (!options.create) return link::map_info(server, options.map);
  return make_map(server, options.map, script.settings.value_or(protocol::MapSettings{}));
}

void warn(const RunOptions& options, const protocol::Script& script, const link::MapInfo& map,
          std::ostream& log) {
  if (script.settings && *script.settings != map.settings)
    log << "warning: the script's settings are not those of map " << options.map << '\n';
  if (map.seq > 0)
    log << "warning: map " << options.map << " is not new, its seq is " << map.seq << '\n';
}

}  // namespace

ExitCode run_command(const RunOptions& options, std::ostream& out, std::ostream& log) {
  const auto script = load(options.script);
  if (!script) return log << script.error().detail << '\n', kUsage;
  const auto server = link::parse_server(options.server);
  if (!server) return log << server.error().detail << '\n', kUsage;
  const auto map = prepare(options, *server, *script);
  if (!map) return log << map.error().detail << '\n', kUsage;
  warn(options, *script, *map, log);

  const PaintReport report = paint({.server = *server,
                                    .map = options.map,
                                    .window = options.window,
                                    .edits_per_second = options.rate,
                                    .patience = options.patience},
                                   script->steps, log);
  const ExitCode code = exit_code(report);
  if (code != kUsage) out << write_report(report).dump() << std::endl;
  return code;
}

}  // namespace earthwork::bot
