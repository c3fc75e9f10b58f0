#include "tests/e2e/server_answers.hpp"

#include <chrono>
#include <stdexcept>
#include <thread>

#include "client/link/http_client.hpp"

namespace earthwork::e2e {

using nlohmann::json;
using namespace std::chrono_literals;

namespace {

template <class Condition>
bool wait_for(const ServerProgram& server, const std::string& map, const char* key,
              Condition condition) {
  const auto give_up = std::chrono::steady_clock::now() + 60s;
  while (std::chrono::steady_clock::now() < give_up) {
    const auto answer = link::http_get(server.address(), "/api/maps/" + map);
    if (answer && answer->status == 200 &&
        condition(json::parse(answer->body)[key].get<std::uint64_t>()))
      return true;
    std::this_thread::sleep_for(5ms);
  }
  return false;
}

}  // namespace

std::string get(const ServerProgram& server, const std::string& target) {
  const auto answer =
      link::http_get(server.address(), target, {.max_body_bytes = std::size_t{64} * 1024 * 1024});
  if (!answer) throw std::runtime_error(answer.error().detail);
  if (answer->status != 200) throw std::runtime_error(target + " is answered: " + answer->body);
  return answer->body;
}

json figures(const ServerProgram& server, const std::string& map) {
  return json::parse(get(server, "/api/maps/" + map + "/figures"));
}

bool wait_for_seq(const ServerProgram& server, const std::string& map, std::uint64_t seq) {
  return wait_for(server, map, "seq", [seq](std::uint64_t now) { return now >= seq; });
}

bool wait_for_users(const ServerProgram& server, const std::string& map, std::uint64_t users) {
  return wait_for(server, map, "users", [users](std::uint64_t now) { return now == users; });
}

json report(const Outcome& outcome) {
  const auto end = outcome.out.find_last_not_of('\n');
  if (end == std::string::npos) throw std::runtime_error("nothing printed; " + outcome.err);
  const auto line = outcome.out.rfind('\n', end);
  return json::parse(outcome.out.substr(line == std::string::npos ? 0 : line + 1));
}

}  // namespace earthwork::e2e
