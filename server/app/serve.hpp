/// The subcommand `serve`: from its flags to a server that runs until it is told to end.
#pragma once

#include <string>
#include <vector>

namespace earthwork::app {

struct ServeFlags {
  std::string data = "earthwork-data";
  std::string listen = "127.0.0.1:8080";
  std::vector<std::string> allow_hosts;
  /// A folder; empty: ../share/earthwork/page beside the program, where it is there.
  std::string page;
  bool memory = false;
  int idle_seconds = 60;
  bool insecure_open = false;
  bool demo = false;
};

/// Serves until SIGTERM or SIGINT. Gives back the exit code: 0; 1 when not all that was accepted
/// could be stored at the end; 2 for flags that do not do, a folder that cannot be used or that
/// another server uses, a page that cannot be served. Each with a line on stderr.
int serve(const ServeFlags& flags);

}  // namespace earthwork::app
