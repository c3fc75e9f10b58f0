/// What the page starts its viewer with: JSON from the page's own script, which puts links, what it
/// remembers and what people typed into it; so it is checked like anybody's input.
#pragma once

#include <string_view>

#include "client/viewer/viewer.hpp"
#include "protocol/result.hpp"

namespace earthwork::viewer {

/// {"map","name","color"?,"key"?,"last_id"?,"seed"?,"place"?:{"x","y","zoom","yaw"?,"tilt"?}}.
/// Fails with bad_json, bad_field, bad_name or out_of_range.
[[nodiscard]] protocol::Result<ViewerOptions> read_start_options(std::string_view json);

}  // namespace earthwork::viewer
