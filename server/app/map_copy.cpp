#include "server/app/map_copy.hpp"

#include <nlohmann/json.hpp>

#include "protocol/chunk_record.hpp"
#include "server/app/answer.hpp"
#include "server/app/stored_map.hpp"
#include "server/journal/map_file.hpp"
#include "server/room/entropy.hpp"

namespace earthwork::app {

using journal::DataDirectory;

int fork_map(const MapFlags& flags) {
  for (const std::string* name : {&flags.name, &flags.new_name})
    if (const auto checked = check_name(*name); !checked) return refuse(checked.error());
  const auto folder = DataDirectory::open(flags.data, DataDirectory::Missing::refuse);
  if (!folder) return refuse(folder.error());

  const std::uint64_t epoch = room::random_u64();
  const auto place = (*folder)->map_file(flags.new_name);
  const auto forked =
      journal::fork_map_file((*folder)->map_file(flags.name), place, epoch, now_ms(), flags.seq);
  if (!forked) return refuse(forked.error());
  const auto made = journal::open_map_file(place, journal::Access::read);
  if (!made) return refuse(made.error());
  return answer(
      {{"name", flags.new_name}, {"epoch", protocol::hex(epoch)}, {"seq", (*made)->last_seq()}});
}

int delete_map(const MapFlags& flags) {
  if (const auto checked = check_name(flags.name); !checked) return refuse(checked.error());
  const auto folder = DataDirectory::open(flags.data, DataDirectory::Missing::refuse);
  if (!folder) return refuse(folder.error());
  const auto removed = journal::remove_map_file((*folder)->map_file(flags.name));
  if (!removed) return refuse(removed.error());
  return answer({{"name", flags.name}, {"deleted", true}});
}

}  // namespace earthwork::app
