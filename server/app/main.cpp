// earthwork-server: the flags of its subcommands.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "server/app/answer.hpp"
#include "server/app/map_command.hpp"
#include "server/app/serve.hpp"

namespace {

using earthwork::app::kFailed;
using earthwork::app::kUsage;
using earthwork::app::refuse;

constexpr const char* kVersion = "earthwork-server " EARTHWORK_VERSION;

void add_serve(CLI::App& app, earthwork::app::ServeFlags& flags) {
  CLI::App* serve = app.add_subcommand("serve", "Serve maps over HTTP and WebSocket");
  serve->set_version_flag("--version", kVersion);
  serve->add_option("--data", flags.data, "Folder that the maps are kept in; made where missing")
      ->capture_default_str();
  serve->add_option("--listen", flags.listen, "HOST:PORT; port 0 picks a free one")
      ->capture_default_str();
  serve->add_flag("--memory", flags.memory, "Keep nothing on disk: maps are gone at the end");
  serve
      ->add_option("--idle", flags.idle_seconds,
                   "Seconds after which a map that nobody uses leaves memory, 1 to 86400")
      ->check(CLI::Range(1, 86'400))
      ->capture_default_str();
  serve->add_option("--page", flags.page,
                    "Folder with the viewer's page as its build left it, served at /; "
                    "../share/earthwork/page beside this program where it is there");
  serve->add_flag("--demo", flags.demo,
                  "Paint a map named demo that shows something, where there is none");
  serve->add_flag("--insecure-open", flags.insecure_open,
                  "Allow an address that other machines can reach: anybody there may paint");
  serve->add_option("--allow-host", flags.allow_hosts,
                    "HOST or HOST:PORT by which the server may be addressed, beside the listening "
                    "address and localhost");
}

/// Whoever starts the program may have closed its streams. Then what is opened first would take
/// their numbers, and results and logs would end up in it: in a map's file or a socket.
void occupy_closed_streams() {
  constexpr int kLastStream = 2;
  for (;;) {
    std::FILE* nothing = std::fopen("/dev/null", "r");
    if (nothing == nullptr) return;
    if (fileno(nothing) <= kLastStream) continue;  // it stays open
    std::fclose(nothing);
    return;
  }
}

int run(int argc, char** argv) {
  CLI::App app{"Earthwork: maps that many can paint together"};
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);
  earthwork::app::ServeFlags flags;
  add_serve(app, flags);
  earthwork::app::MapCommand map;
  earthwork::app::add_map_command(app, map, kVersion);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    return refuse(kUsage, std::string(error.what()) + " (--help says more)");
  }
  return map.run ? map.run(map.flags) : earthwork::app::serve(flags);
}

}  // namespace

int main(int argc, char** argv) {
  occupy_closed_streams();
  try {
    spdlog::set_default_logger(spdlog::stderr_color_mt("earthwork"));
    return run(argc, argv);
  } catch (const std::exception& error) {
    return refuse(kFailed, error.what());
  }
}
