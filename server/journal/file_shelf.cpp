// The shelf of a server that keeps its maps in a data directory.
#include <system_error>
#include <utility>

#include "server/journal/map_file.hpp"
#include "server/journal/shelf.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;
using protocol::Result;

class FileShelf final : public Shelf {
 public:
  explicit FileShelf(std::unique_ptr<DataDirectory> folder) : folder_(std::move(folder)) {}

  [[nodiscard]] bool kept() const override { return true; }
  [[nodiscard]] Result<std::vector<std::string>> names() const override {
    return folder_->map_names();
  }
  [[nodiscard]] Result<std::unique_ptr<Journal>> create(std::string_view name,
                                                        const Identity& identity) override {
    return create_map_file(folder_->map_file(name), identity);
  }
  [[nodiscard]] Result<std::unique_ptr<Journal>> open(std::string_view name) override {
    return open_map_file(folder_->map_file(name), Access::write);
  }
  [[nodiscard]] Result<void> remove(std::string_view name) override {
    return remove_map_file(folder_->map_file(name));
  }
  [[nodiscard]] Result<std::unique_ptr<Clerk>> hire(std::unique_ptr<Journal> journal) override {
    try {
      return hire_clerk(std::move(journal));
    } catch (const std::system_error& error) {  // threads are not had without end
      return protocol::fail(Code::unavailable,
                            std::string("map: no thread for it: ") + error.what(), "map");
    }
  }

 private:
  std::unique_ptr<DataDirectory> folder_;
};

}  // namespace

std::unique_ptr<Shelf> make_file_shelf(std::unique_ptr<DataDirectory> folder) {
  return std::make_unique<FileShelf>(std::move(folder));
}

}  // namespace earthwork::journal
