/// An edit script: JSON lines, a map's settings first and then edits, changes of layers and waits.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/action.hpp"
#include "protocol/edit.hpp"
#include "protocol/layer_change.hpp"
#include "protocol/result.hpp"
#include "protocol/settings.hpp"

namespace earthwork::protocol {

/// Nothing is sent for so long.
struct Wait {
  std::int64_t ms = 0;  ///< 0 .. kMaxWaitMs.
  friend bool operator==(const Wait&, const Wait&) = default;
};

/// A line that has nothing to say to a bot.
struct Note {
  friend bool operator==(const Note&, const Note&) = default;
};

using ScriptStep = std::variant<Edit, LayerChange, Wait>;
using ScriptLine = std::variant<MapSettings, Edit, LayerChange, Wait, Note>;

struct Script {
  std::optional<MapSettings> settings;  ///< None when the first line is not settings.
  std::vector<ScriptStep> steps;
  friend bool operator==(const Script&, const Script&) = default;
};

/// One line, not blank, with or without its line break: an object with "map", "stencil", "wait_ms"
/// or of kind "layer", or one with unknown keys alone, which is a note. Unknown keys are ignored;
/// other keys of an edit without "stencil" are bad_message, and a kind that is not known is
/// not_supported. The line obeys the limits of a control message.
[[nodiscard]] Result<ScriptLine> read_script_line(std::string_view line);

/// A whole script. Blank lines and notes are skipped; settings stand on the first other line, or
/// nowhere. A failure's detail begins with "line N: ", counted from 1.
[[nodiscard]] Result<Script> read_script(std::string_view text);

}  // namespace earthwork::protocol
