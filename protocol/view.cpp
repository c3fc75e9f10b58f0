// check_view: how much of a map a view may ask for.
#include <string>

#include "protocol/limits.hpp"
#include "protocol/messages.hpp"

namespace earthwork::protocol {

Result<void> check_view(const View& view, const MapSettings& settings) {
  if (!view.rect) return {};
  const std::uint64_t chunks = chunks_of_cells(*view.rect, settings).count();
  if (chunks <= kMaxViewChunks) return {};
  return fail(Code::too_large,
              "rect: " + std::to_string(chunks) + " chunks are beyond the limit of " +
                  std::to_string(kMaxViewChunks),
              "rect");
}

}  // namespace earthwork::protocol
