// earthwork-server: the flags of its subcommands.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "server/app/serve.hpp"

namespace {

constexpr const char* kVersion = "earthwork-server " EARTHWORK_VERSION;
constexpr int kFailed = 1, kUsage = 2;

void add_serve(CLI::App& app, earthwork::app::ServeFlags& flags) {
  CLI::App* serve = app.add_subcommand("serve", "Serve maps over HTTP and WebSocket");
  serve->set_version_flag("--version", kVersion);
  serve->add_option("--data", flags.data, "Folder for what is kept")->capture_default_str();
  serve->add_option("--listen", flags.listen, "HOST:PORT; port 0 picks a free one")
      ->capture_default_str();
  serve->add_flag("--memory", flags.memory, "Keep nothing on disk");
  serve->add_flag("--demo", flags.demo, "Start with a map named demo that shows something");
  serve->add_flag("--insecure-open", flags.insecure_open,
                  "Allow an address that other machines can reach: anybody there may paint");
  serve->add_option("--allow-host", flags.allow_hosts,
                    "HOST or HOST:PORT by which the server may be addressed, beside the listening "
                    "address and localhost");
}

int run(int argc, char** argv) {
  CLI::App app{"Earthwork: maps that many can paint together"};
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);
  earthwork::app::ServeFlags flags;
  add_serve(app, flags);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "earthwork-server: %s (--help says more)\n", error.what());
    return kUsage;
  }
  return earthwork::app::serve(flags);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    spdlog::set_default_logger(spdlog::stderr_color_mt("earthwork"));
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "earthwork-server: %s\n", error.what());
    return kFailed;
  }
}
