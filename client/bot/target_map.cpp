#include "client/bot/target_map.hpp"

namespace earthwork::bot {

using protocol::Code;

protocol::Result<link::MapInfo> make_map(const link::ServerAddress& server, const std::string& name,
                                         const protocol::MapSettings& settings) {
  const auto created = link::create_map(server, name, settings);
  if (!created && created.error().code != Code::map_exists)
    return tl::unexpected<protocol::Failure>(created.error());
  auto info = link::map_info(server, name);
  if (info && info->settings != settings)
    return protocol::fail(Code::map_exists,
                          "map: there is a map " + name + " with other settings already", "map");
  return info;
}

}  // namespace earthwork::bot
