// earthwork-bot: the command line. Each subcommand is a file of its own.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <string>

#include "client/bot/flag_value.hpp"
#include "client/bot/load_command.hpp"
#include "client/bot/run_command.hpp"
#include "client/bot/trace_command.hpp"
#include "client/bot/watch_command.hpp"
#include "protocol/json_fields.hpp"
#include "protocol/limits.hpp"

namespace {

using namespace earthwork::bot;
namespace protocol = earthwork::protocol;

constexpr const char* kExitCodes =
    "Exit codes: 0 done, 1 the work failed, was cut short or was refused in part, 2 wrong usage "
    "or nothing to talk to.";
constexpr double kMaxSeconds = 1e9, kMaxRate = 1e9, kMaxLength = 1e12;
constexpr std::size_t kMaxWindow = 4096;
constexpr std::uint64_t kMaxCrowd = 100'000, kMaxThreads = 64, kMaxSeed = 1'000'000'000;

CLI::Validator whole(std::uint64_t min, std::uint64_t max) {
  return {[=](const std::string& text) { return check_whole(text, min, max); },
          std::to_string(min) + " .. " + std::to_string(max)};
}

CLI::Validator number(double min, double max) {
  return {[=](const std::string& text) { return check_number(text, min, max); },
          protocol::plain(min) + " .. " + protocol::plain(max)};
}

template <class Options>
void add_target(CLI::App& command, Options& options) {
  command.add_option("--server", options.server, "The server, http://HOST:PORT")->required();
  command.add_option("--map", options.map, "The map's name")->required();
}

template <class Options>
void add_patience(CLI::App& command, Options& options) {
  command
      .add_option_function<double>(
          "--patience",
          [&options](double seconds) {
            options.patience = std::chrono::duration_cast<std::chrono::milliseconds>(
                std::chrono::duration<double>(seconds));
          },
          "Seconds without a connection until the server is taken to be gone for good; a broken "
          "connection is tried again till then, and nothing is lost")
      ->check(number(0, kMaxSeconds))
      ->default_str("60");
}

void add_run(CLI::App& app, RunOptions& options) {
  CLI::App& run = *app.add_subcommand("run", "Sends the edits of a script in order");
  run.add_option("SCRIPT", options.script,
                 "JSON lines: the map's settings, then edits and changes of layers")
      ->required();
  add_target(run, options);
  run.add_flag("--create", options.create,
               "Make the map with the script's settings; one that exists is used when its settings "
               "are equal, and refused otherwise");
  run.add_option("--window", options.window, "Edits without an answer, at most")
      ->check(whole(1, kMaxWindow))
      ->capture_default_str();
  run.add_option("--rate", options.rate, "Edits a second, at most")->check(number(1e-3, kMaxRate));
  add_patience(run, options);
  run.footer(
      std::string("Prints one line, also when interrupted or when the server goes away for good: "
                  "{\"edits\" sent, \"acked\", \"rejected\", \"seconds\", \"ack_p50_ms\", "
                  "\"ack_p99_ms\", \"seq\"}. {\"wait_ms\":N} in a script sends nothing for "
                  "so long.\n") +
      kExitCodes);
}

void add_trace(CLI::App& app, TraceOptions& options, bool& invert) {
  CLI::App& trace = *app.add_subcommand("trace", "Paints a picture, one voxel a pixel");
  trace.add_option("IMAGE", options.image, "A PNG file of up to 2^26 pixels")->required();
  add_target(trace, options);
  trace.add_flag("--create", options.create,
                 "Make a map just large enough; one that exists is used when its settings are "
                 "equal, and refused otherwise");
  trace
      .add_option("--threshold", options.threshold,
                  "Pixels of a grey below it are filled; transparent ones are laid over white")
      ->check(whole(0, 256))
      ->capture_default_str();
  trace.add_flag("--invert", invert, "Fill the other pixels instead");
  trace.add_option("--resolution", options.resolution, "Voxels along a chunk of a map made here")
      ->check(whole(8, 64))
      ->check(CLI::IsMember({8, 16, 32, 64}))
      ->capture_default_str();
  add_patience(trace, options);
  trace.footer(
      std::string("The lower left pixel is voxel (0, 0) of layer 0, the top row is up. Where the "
                  "map is not new, the ground under the picture is emptied first. Prints the line "
                  "of run, with \"stamps\" and \"pixels\".\n") +
      kExitCodes);
}

void add_watch(CLI::App& app, WatchCommandOptions& options) {
  CLI::App& watch =
      *app.add_subcommand("watch", "Builds the mesh of all of a map from frames alone");
  add_target(watch, options);
  watch.add_option("--until-seq", options.until_seq, "End once this event is shown")
      ->check(whole(0, protocol::kMaxInteger));
  watch.add_option("--seconds", options.seconds, "End after so long")
      ->check(number(0, kMaxSeconds));
  watch.add_option("--glb", options.glb, "Write the mesh to this file, as glTF");
  add_patience(watch, options);
  watch.footer(
      std::string(
          "Without --until-seq and --seconds it ends once it has all of the map; with both, "
          "at whichever comes first. A view, and so watch, holds at most 16,384 chunks: a larger "
          "map is refused. Prints one line: {\"seq\", \"frames\", \"bytes\", "
          "\"chunks\", \"mesh_hash\"}.\n") +
      kExitCodes);
}

void add_load(CLI::App& app, LoadOptions& options) {
  CLI::App& load = *app.add_subcommand("load", "Many editors and viewers at once");
  add_target(load, options);
  const auto count = [&](const char* flag, std::size_t& value, const char* what) {
    return load.add_option(flag, value, what)->check(whole(0, kMaxCrowd))->capture_default_str();
  };
  count("--editors", options.editors, "That paint circles along walks drawn by lot")->required();
  count("--viewers", options.viewers, "That watch all of the map")->required();
  load.add_option("--seconds", options.seconds, "How long is painted")
      ->required()
      ->check(number(1e-3, kMaxSeconds));
  load.add_option("--rate", options.rate,
                  "Edits a second of each editor; without it 64 are without an answer, always")
      ->check(number(1e-3, kMaxRate));
  load.add_option("--radius", options.radius, "Of the circles, map units")
      ->check(number(1e-6, kMaxLength))
      ->capture_default_str();
  load.add_option("--area", options.area, "The side of the square that is painted on, map units")
      ->check(number(1e-6, kMaxLength))
      ->capture_default_str();
  count("--slow", options.slow, "Of the viewers, that read 1 KB a second");
  count("--stalled", options.stalled,
        "Of the viewers, that read nothing for the first two thirds, a minute at most");
  count("--flaky", options.flaky, "Of the viewers, that cut and come back at random moments");
  load.add_option("--threads", options.threads, "For the connections")
      ->check(whole(1, kMaxThreads))
      ->capture_default_str();
  load.add_flag("--create", options.create,
                "Make the map, with default settings, if there is none");
  load.add_option("--seed", options.seed, "Of what is drawn by lot")
      ->check(whole(0, kMaxSeed))
      ->capture_default_str();
  load.footer(
      std::string(
          "At the end painting stops, all read at full speed until they show the last edit, and "
          "each scene is compared with the server's mesh_hash: 0 only if all agree and every edit "
          "was applied. Nobody else should paint on the map meanwhile. Prints one line of figures: "
          "edits, frames and bytes, latencies from sending to answer (ack_ms) and to picture "
          "(view_ms), the bytes of the voxel data that the edits stand for: of each chunk with a "
          "changed voxel, a bit a voxel and 6 bytes a crossing. When the generator itself was late "
          "by more than 1 ms or more than 80 % busy, it says so.\n") +
      kExitCodes);
}

/// A stream that was closed for this program must not become a socket or a file of its own: what
/// is printed would land there. A file takes the first free place; open for reading, it refuses
/// what is printed.
void keep_standard_streams() {
  constexpr int kLast = 2;
  std::FILE* nothing = nullptr;
  do nothing = std::fopen("/dev/null", "r");
  while (nothing && fileno(nothing) <= kLast);
  if (nothing) std::fclose(nothing);
}

int run_program(int argc, char** argv) {
  CLI::App app("Paints maps on an Earthwork server, and watches them.", "earthwork-bot");
  app.set_version_flag("--version", std::string("earthwork-bot ") + EARTHWORK_VERSION);
  app.require_subcommand(0, 1);
  app.footer(kExitCodes);
  RunOptions run;
  TraceOptions trace;
  WatchCommandOptions watch;
  LoadOptions load;
  bool invert = false;
  add_run(app, run);
  add_trace(app, trace, invert);
  add_watch(app, watch);
  add_load(app, load);
  for (CLI::App* command : app.get_subcommands({}))
    command->set_version_flag("--version", std::string("earthwork-bot ") + EARTHWORK_VERSION);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error, std::cout, std::cerr);
    std::cerr << "earthwork-bot: " << error.what() << " (--help tells more)\n";
    return kUsage;
  }
  if (app.get_subcommands().empty()) {
    std::cerr << "earthwork-bot: run, trace, watch or load? (--help tells more)\n";
    return kUsage;
  }
  if (app.got_subcommand("run")) return run_command(run, std::cout, std::cerr);
  if (app.got_subcommand("watch")) return watch_command(watch, std::cout, std::cerr);
  if (app.got_subcommand("load")) return load_command(load, std::cout, std::cerr);
  trace.ink = invert ? Ink::light : Ink::dark;
  return trace_command(trace, std::cout, std::cerr);
}

}  // namespace

int main(int argc, char** argv) {
  keep_standard_streams();
  try {
    const int code = run_program(argc, argv);
    if (std::cout.flush()) return code;
    std::cerr << "earthwork-bot: stdout cannot be written\n";
  } catch (const std::exception& error) {
    std::cerr << "earthwork-bot: " << error.what() << '\n';
  }
  return kFailed;
}
