/// A map's settings as a map file keeps them: JSON that people can read.
#pragma once

#include <string>
#include <string_view>

#include "protocol/result.hpp"
#include "protocol/settings.hpp"

namespace earthwork::journal {

/// The same text for equal settings.
[[nodiscard]] std::string text_of(const protocol::MapSettings& settings);
/// Fails as protocol::read_settings does, or with bad_json.
[[nodiscard]] protocol::Result<protocol::MapSettings> settings_of(std::string_view text);

}  // namespace earthwork::journal
