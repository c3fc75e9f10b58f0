#include "server/journal/settings_text.hpp"

#include <nlohmann/json.hpp>

#include "protocol/json_text.hpp"
#include "protocol/limits.hpp"

namespace earthwork::journal {

std::string text_of(const protocol::MapSettings& settings) {
  return protocol::write_settings(settings).dump();
}

protocol::Result<protocol::MapSettings> settings_of(std::string_view text) {
  const auto json = protocol::parse_json(text, protocol::kMaxServerControlBytes);
  if (!json) return tl::unexpected<protocol::Failure>(json.error());
  return protocol::read_settings(*json);
}

}  // namespace earthwork::journal
