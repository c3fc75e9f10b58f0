// What a server tells about its maps, for tests to compare.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tests/e2e/program.hpp"

namespace earthwork::e2e {

/// The body of GET `target`; throws unless it is answered with 200.
std::string get(const ServerProgram& server, const std::string& target);

/// GET /api/maps/NAME/figures.
nlohmann::json figures(const ServerProgram& server, const std::string& map);

/// Waits until the map is at this event or later, at most a minute.
bool wait_for_seq(const ServerProgram& server, const std::string& map, std::uint64_t seq);
/// Waits until exactly so many people are on the map, at most a minute.
bool wait_for_users(const ServerProgram& server, const std::string& map, std::uint64_t users);

/// The last line that a program printed, as JSON.
nlohmann::json report(const Outcome& outcome);

}  // namespace earthwork::e2e
