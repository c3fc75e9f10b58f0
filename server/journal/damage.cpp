#include "server/journal/damage.hpp"

#include <string>
#include <utility>

namespace earthwork::journal {
namespace {

/// What stands before a sentence.
std::string place(std::string_view file, std::string_view table) {
  std::string text;
  for (const std::string_view part : {file, table})
    if (!part.empty()) (text += part) += ": ";
  return text;
}

}  // namespace

tl::unexpected<protocol::Failure> damage(std::string_view file, std::string_view table,
                                         std::uint64_t seq, std::string_view sentence) {
  std::string detail = place(file, table);
  if (seq != 0) detail += "seq " + std::to_string(seq) + ": ";
  return protocol::fail(protocol::Code::damaged, detail += sentence);
}

protocol::Failure in_events_of(const Journal& journal, protocol::Failure failure) {
  failure.detail.insert(0, place(journal.name(), "events"));
  return failure;
}

}  // namespace earthwork::journal
