// The shelf of a server that keeps nothing.
#include <utility>

#include "server/journal/memory_journal.hpp"
#include "server/journal/shelf.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;
using protocol::Result;

class MemoryShelf final : public Shelf {
 public:
  [[nodiscard]] bool kept() const override { return false; }
  [[nodiscard]] Result<std::vector<std::string>> names() const override { return {}; }
  [[nodiscard]] Result<std::unique_ptr<Journal>> create(std::string_view,
                                                        const Identity& identity) override {
    return make_memory_journal(identity);
  }
  [[nodiscard]] Result<std::unique_ptr<Journal>> open(std::string_view name) override {
    return protocol::fail(Code::unknown_map, "map: there is no " + std::string(name), "map");
  }
  [[nodiscard]] Result<void> remove(std::string_view) override { return {}; }
  [[nodiscard]] Result<std::unique_ptr<Clerk>> hire(std::unique_ptr<Journal> journal) override {
    return immediate_clerk(std::move(journal));
  }
};

}  // namespace

std::unique_ptr<Shelf> make_memory_shelf() { return std::make_unique<MemoryShelf>(); }

}  // namespace earthwork::journal
