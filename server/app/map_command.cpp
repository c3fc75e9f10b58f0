#include "server/app/map_command.hpp"

#include <CLI/CLI.hpp>

#include "server/app/map_copy.hpp"
#include "server/app/map_export.hpp"
#include "server/app/map_import.hpp"
#include "server/app/map_report.hpp"

namespace earthwork::app {
namespace {

/// Adds subcommands that are alike in what all of them have.
class Adder {
 public:
  Adder(CLI::App& map, MapCommand& command, const char* version)
      : map_(map), command_(command), version_(version) {}

  CLI::App* add(const char* name, const char* what, int (*run)(const MapFlags&)) {
    CLI::App* sub = map_.add_subcommand(name, what);
    sub->set_version_flag("--version", version_);
    sub->add_option("--data", command_.flags.data, "Folder that the maps are kept in")
        ->capture_default_str();
    sub->callback([&command = command_, run] { command.run = run; });
    return sub;
  }
  CLI::App* add_named(const char* name, const char* what, int (*run)(const MapFlags&)) {
    CLI::App* sub = add(name, what, run);
    sub->add_option("NAME", command_.flags.name, "The map")->required();
    return sub;
  }
  void add_seq(CLI::App* sub, const char* what) {
    sub->add_option("--seq", command_.flags.seq, what);
  }
  void add_file(CLI::App* sub, const char* name, const char* what) {
    sub->add_option(name, command_.flags.file, what)->required();
  }

 private:
  CLI::App& map_;
  MapCommand& command_;
  const char* version_;
};

}  // namespace

void add_map_command(CLI::App& program, MapCommand& command, const char* version) {
  CLI::App* map = program.add_subcommand("map", "Look after the maps of a data directory");
  map->set_version_flag("--version", version);
  map->require_subcommand(1);
  Adder adder(*map, command, version);

  adder.add("list", "A line for each map", list_maps);
  adder.add_named("info", "A map's settings and figures", show_map);
  CLI::App* hash = adder.add_named("hash", "The hash of a map, executed", hash_map);
  adder.add_seq(hash, "As of that event in place of the last");
  adder.add_named("verify", "Execute the log again and compare all that is stored", verify_map);

  CLI::App* exported = adder.add_named("export", "Write a map as a file", export_map);
  adder.add_file(exported, "OUT",
                 "OUT.glb, a glTF model; OUT.png, a layer's voxels; OUT.jsonl, a recording");
  adder.add_seq(exported, "As of that event in place of the last");
  exported->add_option("--layer", command.flags.layer, "Of a picture; 0 without it");
  CLI::App* imported =
      adder.add_named("import", "Make a map of a recording, if all of it agrees", import_map);
  adder.add_file(imported, "FILE", "The recording, FILE.jsonl");

  CLI::App* fork = adder.add_named("fork", "Make a map that begins as another one", fork_map);
  fork->add_option("NEW", command.flags.new_name, "The map to make")->required();
  adder.add_seq(fork, "With the events up to that one");
  adder.add_named("delete", "Delete a map, for good", delete_map);
}

}  // namespace earthwork::app
