#include "server/journal/event_pages.hpp"

#include <algorithm>
#include <utility>

#include "server/journal/damage.hpp"

namespace earthwork::journal {
namespace {

using protocol::Code;

tl::unexpected<protocol::Failure> missing(const Journal& journal, std::uint64_t seq) {
  return damage(journal.name(), "events", seq, "is missing");
}

}  // namespace

// A page with damage in it fails as a whole. Smaller ones from the same place then tell what
// stands before the damage, and the smallest fails with the damage itself.
protocol::Result<void> read_events(Journal& journal, std::uint64_t after, std::uint64_t up_to,
                                   const TakeEvent& take) {
  std::size_t most_bytes = kPageBytes;
  while (after < up_to) {
    auto page = journal.events(after + 1, most_bytes);
    if (!page && page.error().code == Code::damaged && most_bytes > 1) {
      most_bytes = std::max<std::size_t>(1, most_bytes / 8);
      continue;
    }
    if (!page) return tl::unexpected<protocol::Failure>(std::move(page.error()));
    if (page->empty()) return missing(journal, after + 1);
    for (const history::Event& event : *page) {
      if (after == up_to) break;
      if (event.seq != after + 1) return missing(journal, after + 1);
      if (auto taken = take(event); !taken) return taken;
      after = event.seq;
    }
  }
  return {};
}

}  // namespace earthwork::journal
