#include "server/journal/execution.hpp"

#include <string>

#include "protocol/chunk_record.hpp"
#include "server/history/fold.hpp"

namespace earthwork::journal {
namespace {

tl::unexpected<protocol::Failure> damaged(std::uint64_t seq, const std::string& sentence) {
  return protocol::fail(protocol::Code::damaged, "seq " + std::to_string(seq) + ": " + sentence);
}

}  // namespace

Execution::Execution(const protocol::MapSettings& settings) : map(history::make_map(settings)) {}

protocol::Result<void> Execution::apply(const history::Event& event) {
  if (event.seq != seq + 1) return damaged(event.seq, std::to_string(seq + 1) + " comes next");
  if (event.edit.layer >= static_cast<std::uint32_t>(map.grid().layers))
    return damaged(event.seq, "layer " + std::to_string(event.edit.layer) + " of a map with " +
                                  std::to_string(map.grid().layers));
  if (!authors.add(event.author, {event.id, event.seq}))
    return damaged(event.seq, "id " + std::to_string(event.id) +
                                  " is not above the last of author " +
                                  protocol::hex(event.author));
  const voxel::Change& change = history::apply(map, event.edit);
  ages.changed(change.changed, event.seq);
  seq = event.seq;
  hash = map.hash();
  if (hash == event.hash) return {};
  return damaged(seq, "the stored hash is " + protocol::hex(event.hash) + ", executed it is " +
                          protocol::hex(hash));
}

}  // namespace earthwork::journal
