#include "tests/net/painter.hpp"

#include <chrono>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

namespace earthwork::net {
namespace {

using nlohmann::json;

std::string edit(std::size_t id) {
  return json{{"type", "edit"},   {"id", id},         {"stencil", "circle"}, {"fill", id % 3 != 0},
              {"x", id * 7 % 64}, {"y", id * 5 % 64}, {"radius", 2.5}}
      .dump();
}

}  // namespace

json reply(SocketClient& client) {
  const std::set<std::string> news{"presence", "event", "caught_up"};
  for (;;) {
    const std::string text = client.receive_text();
    if (text.empty()) return {};
    json message = json::parse(text);
    if (!news.contains(message.at("type"))) return message;
  }
}

void enter(SocketClient& client, const std::string& map) {
  client.text(R"({"type":"hello","protocol":[1,1],"name":"ann","id":1})");
  const json welcome = reply(client);
  client.text(R"({"type":"join","map":")" + map + R"(","id":2})");
  const json joined = reply(client);
  if (joined.is_null() || joined.at("type") != "joined")
    throw std::runtime_error("not let in: " + welcome.dump() + joined.dump());
}

Painter::Painter(std::uint16_t port, std::string map)
    : client_(port), map_(std::move(map)), thread_([this] { paint(); }) {}

Painter::~Painter() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Painter::paint() {
  bool good = true;
  try {
    enter(client_, map_);
    client_.text(R"({"type":"view","n":1,"rect":[0,0,64,64],"id":3})");
    good = reply(client_).at("type") == "done";
    for (std::size_t id = 4; good; ++id) {
      client_.text(edit(id));
      const json answer = reply(client_);
      good = answer.is_object() && answer.at("type") == "applied" && answer.at("id") == id;
      std::unique_lock lock(mutex_);
      if (ending_) return;
      if (good) ++applied_;
      changed_.notify_all();
      // A pause, so that the others have the machine too.
      changed_.wait_for(lock, std::chrono::milliseconds(1), [this] { return ending_; });
    }
  } catch (const std::exception&) {
    good = false;
  }
  const std::lock_guard lock(mutex_);
  failed_ = !good;
  changed_.notify_all();
}

bool Painter::is_answered() {
  std::unique_lock lock(mutex_);
  // The first one may have been under way already.
  const std::size_t enough = applied_ + 2;
  return changed_.wait_for(lock, std::chrono::minutes(1), [&] {
    return failed_ || applied_ >= enough;
  }) && !failed_;
}

}  // namespace earthwork::net
