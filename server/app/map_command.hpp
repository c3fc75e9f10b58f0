/// The subcommand `map`: its flags, and which part of the program does what they ask.
#pragma once

#include "server/app/map_flags.hpp"

namespace CLI {
class App;
}

namespace earthwork::app {

struct MapCommand {
  MapFlags flags;
  int (*run)(const MapFlags&) = nullptr;  ///< The exit code; null: `map` was not asked for.
};

/// Adds `map` to the program; `command` is filled in when arguments are parsed, and outlives it.
void add_map_command(CLI::App& program, MapCommand& command, const char* version);

}  // namespace earthwork::app
