/// Where the maps of a server are kept, by name: in a data directory, or nowhere.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/result.hpp"
#include "server/journal/clerk.hpp"
#include "server/journal/data_directory.hpp"
#include "server/journal/journal.hpp"

namespace earthwork::journal {

/// Any thread, for one name from one thread at a time. Names are valid. Where maps are `kept` every
/// call but that one may take long: none belongs on a strand. Failures are those of the journal.
class Shelf {
 public:
  virtual ~Shelf() = default;

  /// Whether a map whose journal was closed can be opened again. Where not, it is gone with its
  /// journal, and nothing here ever waits.
  [[nodiscard]] virtual bool kept() const = 0;
  /// Of all maps, sound or not, in alphabetic order. No map is opened for it.
  [[nodiscard]] virtual protocol::Result<std::vector<std::string>> names() const = 0;
  /// A new map, there after the call as a whole or not at all. Fails with map_exists too.
  [[nodiscard]] virtual protocol::Result<std::unique_ptr<Journal>> create(
      std::string_view name, const Identity& identity) = 0;
  /// Fails with unknown_map, bad_version or damaged too. Nobody else has it open.
  [[nodiscard]] virtual protocol::Result<std::unique_ptr<Journal>> open(std::string_view name) = 0;
  /// Fails with unknown_map too. Nobody has it open.
  [[nodiscard]] virtual protocol::Result<void> remove(std::string_view name) = 0;
  /// Who does the work on a journal of this shelf. Fails with unavailable when nobody can be had.
  [[nodiscard]] virtual protocol::Result<std::unique_ptr<Clerk>> hire(
      std::unique_ptr<Journal> journal) = 0;
};

/// Journals in memory: a map lives as long as its journal, and none is ever found here.
[[nodiscard]] std::unique_ptr<Shelf> make_memory_shelf();

/// Map files, each with a thread of its own while it is open.
[[nodiscard]] std::unique_ptr<Shelf> make_file_shelf(std::unique_ptr<DataDirectory> folder);

}  // namespace earthwork::journal
