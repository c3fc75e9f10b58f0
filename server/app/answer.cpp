#include "server/app/answer.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

namespace earthwork::app {
namespace {

int exit_code(protocol::Code code) {
  switch (code) {
    case protocol::Code::bad_name:
    case protocol::Code::bad_state:
    case protocol::Code::map_exists:
    case protocol::Code::out_of_range:
    case protocol::Code::unknown_map:
      return kUsage;
    default:
      return kFailed;
  }
}

}  // namespace

int answer(const nlohmann::ordered_json& line) {
  // Names of files and layers may hold anything.
  const std::string text =
      line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  if (std::printf("%s\n", text.c_str()) >= 0 && std::fflush(stdout) == 0) return kDone;
  return refuse(kFailed, "stdout takes nothing");
}

void warn(const std::string& sentence) {
  std::fprintf(stderr, "earthwork-server: %s\n", sentence.c_str());
}

int refuse(int exit_code, const std::string& why) {
  warn(why);
  return exit_code;
}

int refuse(const protocol::Failure& failure) {
  return refuse(exit_code(failure.code), failure.detail);
}

}  // namespace earthwork::app
