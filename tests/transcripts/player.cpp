#include "tests/transcripts/player.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "client/link/event_loop.hpp"
#include "client/link/maps.hpp"
#include "client/link/web_socket.hpp"
#include "protocol/frame.hpp"
#include "tests/e2e/program.hpp"
#include "tests/transcripts/normal_form.hpp"

namespace earthwork::transcripts {
namespace {

using namespace std::chrono_literals;
using Kind = Line::Kind;

constexpr auto kPatience = 60s;  // for a line that is expected
constexpr auto kQuiet = 400ms;   // after which nothing more is expected: empty groups take 100 ms
constexpr auto kBreath = 20ms;   // between lines that should not come at all

class Client {
 public:
  Client(link::EventLoop& loop, const link::ServerAddress& server, NormalForm& normal)
      : loop_(loop),
        normal_(normal),
        socket_(loop, server,
                {.opened = {},
                 .text =
                     [this](std::string_view text) {
                       if (auto line = normal_.text(text)) put(std::move(*line));
                     },
                 .binary = [this](std::span<const std::byte> bytes) { take(bytes); },
                 .closed =
                     [this](link::SocketEnd end, const std::string& why) {
                       put(end == link::SocketEnd::closed ? "closed" : "closed: " + why);
                     }}) {}

  link::WebSocket& socket() { return socket_; }
  std::deque<std::string>& lines() { return lines_; }

 private:
  void put(std::string line) {
    lines_.push_back(std::move(line));
    loop_.stop();
  }

  void take(std::span<const std::byte> bytes) {
    std::vector<protocol::FrameEvent> events;
    const auto taken = frames_.feed(bytes, events);
    for (const auto& event : events)
      for (std::string& line : normal_.frame(event)) put(std::move(line));
    if (!taken) put("not a frame: " + taken.error().detail);
  }

  link::EventLoop& loop_;
  NormalForm& normal_;
  protocol::FrameReader frames_;
  std::deque<std::string> lines_;
  link::WebSocket socket_;
};

class Player {
 public:
  /// Does what a line that is not received says.
  void act(const Line& line) {
    switch (line.kind) {
      case Kind::map:
        return make_map(line.text);
      case Kind::show:
        return show(line.text);
      case Kind::stop:
        return server_.ask_to_end();
      case Kind::close:
        return client(line.client).socket().close();
      case Kind::send:
        return client(line.client).socket().write_text(normal_.filled_in(expand(line.text)));
      case Kind::send_hex:
        return client(line.client).socket().write_binary(bytes_of(line.text));
      case Kind::note:
      case Kind::receive:
        return;
    }
  }

  /// The next line that a client receives; nothing when it receives none.
  std::optional<std::string> next(char name) {
    auto& lines = client(name).lines();
    wait_until([&] { return !lines.empty(); }, kPatience);
    if (lines.empty()) return std::nullopt;
    std::string line = std::move(lines.front());
    lines.pop_front();
    return line;
  }

  /// Waits until a client has received a line, at most so long.
  void wait_for_any(std::chrono::nanoseconds at_most) {
    wait_until(
        [&] {
          return std::any_of(clients_.begin(), clients_.end(),
                             [](const auto& one) { return !one.second->lines().empty(); });
        },
        at_most);
  }

  /// All lines that all clients receive until it is quiet for so long.
  std::vector<Line> all(std::chrono::nanoseconds quiet) {
    std::vector<Line> out;
    std::size_t before = 0;
    do {
      before = out.size();
      wait_until([] { return false; }, quiet);
      for (auto& [name, client] : clients_)
        for (; !client->lines().empty(); client->lines().pop_front())
          out.push_back({.kind = Kind::receive, .client = name, .text = client->lines().front()});
    } while (out.size() > before);
    return out;
  }

 private:
  template <class Condition>
  void wait_until(Condition condition, std::chrono::nanoseconds at_most) {
    bool over = false;
    link::Timer timer(loop_);
    timer.start(at_most, [&] { over = true, loop_.stop(); });
    while (!over && !condition()) loop_.run();
  }

  Client& client(char name) {
    auto& found = clients_[name];
    if (!found) found = std::make_unique<Client>(loop_, server_.address(), normal_);
    return *found;
  }

  void make_map(const std::string& text) {
    const auto space = text.find(' ');
    const auto json = nlohmann::json::parse(space == std::string::npos ? "{}" : text.substr(space));
    const auto settings = protocol::read_settings(json);
    if (!settings) throw std::runtime_error(settings.error().detail);
    const auto made = link::create_map(server_.address(), text.substr(0, space), *settings);
    if (!made) throw std::runtime_error(made.error().detail);
  }

  void show(const std::string& what) {
    if (what == "limits")
      normal_.show_limits = true;
    else if (what == "meshes")
      normal_.show_meshes = true;
    else if (what == "presence")
      normal_.show_presence = true;
    else
      throw std::runtime_error("cannot show " + what);
  }

  static std::string bytes_of(const std::string& digits) {
    std::string out;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
      out += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
    return out;
  }

  e2e::ServerProgram server_;
  link::EventLoop loop_;
  NormalForm normal_;
  std::map<char, std::unique_ptr<Client>> clients_;
};

/// Something that a server may answer.
bool is_said(const Line& line) {
  return line.kind == Kind::send || line.kind == Kind::send_hex || line.kind == Kind::close ||
         line.kind == Kind::stop;
}

}  // namespace

std::string play(const Transcript& transcript, std::chrono::nanoseconds epilogue) {
  Player player;
  for (std::size_t i = 0; i < transcript.lines.size(); ++i) {
    const Line& line = transcript.lines[i];
    if (line.kind != Kind::receive) {
      player.act(line);
      continue;
    }
    const auto received = player.next(line.client);
    if (received != line.text)
      return "line " + std::to_string(i + 1) + " of the transcript\n  expected " + line.text +
             "\n  received " + received.value_or("nothing");
  }
  std::string extra;
  player.wait_for_any(epilogue);
  for (const Line& line : player.all(kBreath))
    extra += std::string(1, line.client) + " received more: " + line.text + "\n";
  return extra;
}

Transcript record(const Transcript& transcript) {
  Player player;
  Transcript out;
  const auto& lines = transcript.lines;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].kind == Kind::receive) continue;
    player.act(lines[i]);
    out.lines.push_back(lines[i]);
    // What is said in one breath is answered in one.
    const bool in_one_breath = i + 1 < lines.size() && is_said(lines[i + 1]);
    if (!is_said(lines[i]) || in_one_breath) continue;
    const auto received = player.all(kQuiet);
    out.lines.insert(out.lines.end(), received.begin(), received.end());
  }
  return out;
}

}  // namespace earthwork::transcripts
