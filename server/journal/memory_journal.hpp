/// A journal that ends with the process.
#pragma once

#include <memory>

#include "server/journal/journal.hpp"

namespace earthwork::journal {

/// Keeps everything that a file would; never fails but for what the caller did wrong.
[[nodiscard]] std::unique_ptr<Journal> make_memory_journal(Identity identity);

}  // namespace earthwork::journal
