// What a server sends, as a line that is the same in every run.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/frame.hpp"

namespace earthwork::transcripts {

class NormalForm {
 public:
  bool show_limits = false, show_meshes = false, show_presence = false;

  /// A control message, its random values replaced by names; nothing for one that is not shown.
  std::optional<std::string> text(std::string_view message);
  /// A line an event, and more for a record when meshes are shown.
  std::vector<std::string> frame(const protocol::FrameEvent& event);
  /// The text with each name of a random value replaced by the value.
  std::string filled_in(std::string text) const;

 private:
  void walk(nlohmann::ordered_json& json);
  void replace(const std::string& key, nlohmann::ordered_json& value);
  const std::string& name_of(const std::string& kind, const std::string& value);
  std::vector<std::string> record(const protocol::ChunkRecord& record) const;

  std::map<std::string, std::string> names_;  // by value
  std::map<std::string, int> counts_;         // by kind
};

}  // namespace earthwork::transcripts
