#include "server/room/opening.hpp"

#include <utility>

#include "server/history/fold.hpp"
#include "server/journal/memory_journal.hpp"

namespace earthwork::room {

Opening open_in_memory(const journal::Identity& identity) {
  return open_empty(identity, journal::immediate_clerk(journal::make_memory_journal(identity)),
                    Commits::at_once);
}

Opening open_empty(const journal::Identity& identity, std::unique_ptr<journal::Clerk> clerk,
                   Commits commits) {
  return {.identity = identity,
          .restored = {.map = history::make_map(identity.settings),
                       .settings = identity.settings,
                       .ages = {},
                       .authors = {},
                       .passed_over = {}},
          .clerk = std::move(clerk),
          .commits = commits};
}

}  // namespace earthwork::room
