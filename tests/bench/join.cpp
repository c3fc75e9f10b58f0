// earthwork-join: how long a viewer waits until all of its view is there, and how many bytes that
// takes: all of a map of 1,024 x 1,024 voxels, and as large a view into one of 16,384 x 16,384.
//
// The viewer is the project's own client, decoding and scene included. Both maps hold circles drawn
// by lot, equally dense.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <exception>
#include <iostream>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "client/link/http_client.hpp"
#include "client/link/link.hpp"
#include "client/link/maps.hpp"
#include "client/scene/scene.hpp"
#include "protocol/limits.hpp"
#include "tests/bench/child_process.hpp"
#include "tests/bench/timing.hpp"

namespace {

using namespace earthwork;
using namespace earthwork::bench;
using Clock = std::chrono::steady_clock;

constexpr const char* kUsage =
    "usage: earthwork-join REPS\n"
    "REPS 1 .. 1000 joins of each map, after one that is not counted; one JSON line a map on\n"
    "stdout, medians: ms from opening the connection and from sending the view to caught_up.\n";

constexpr double kViewSide = 1024;
constexpr double kVoxelsPerCircle = 1024;  // one in every 32 x 32 voxels
constexpr double kLeastRadius = 2, kMostRadius = 20;
constexpr std::size_t kWindow = 8;

protocol::Hello hello() {
  protocol::Hello out;
  out.name = "join";
  return out;
}

/// Paints until `circles` are there, in edits with as long a path as they may have.
class Ground {
 public:
  Ground(const link::ServerAddress& server, const std::string& map, double side)
      : side_(side),
        left_(static_cast<std::size_t>(side * side / kVoxelsPerCircle)),
        link_(loop_, {.server = server, .hello = hello(), .map = map},
              {.ready = [this] { send(); },
               .message = [this](const auto& message) { take(message); },
               .frame = {},
               .closed = [this](const auto&) { loop_.stop(); }}) {
    loop_.run();
    if (left_ > 0 || unanswered_ > 0) throw std::runtime_error("the map could not be painted");
  }

 private:
  double between(double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(random_() >> 11), -53);
  }

  // One radius an edit; the centres of a path lie in one square of 16 x 16 chunks, so that the
  // edit stays within the chunks that one may touch.
  protocol::Edit next() {
    constexpr double kSquare = 512;
    const auto squares = static_cast<std::uint64_t>(side_ / kSquare);
    const double x0 = static_cast<double>(edits_ % squares) * kSquare;
    const double y0 = static_cast<double>(edits_ / squares % squares) * kSquare;
    ++edits_;
    protocol::Edit edit;
    edit.fill = between(0, 1) < 0.75;
    edit.radius = between(kLeastRadius, kMostRadius);
    edit.is_path = true;
    for (int i = 0; i < 16 && left_ > 0; ++i, --left_)
      edit.path.push_back({.x = x0 + between(0, kSquare), .y = y0 + between(0, kSquare)});
    return edit;
  }

  void send() {
    for (; left_ > 0 && unanswered_ < kWindow; ++unanswered_)
      if (!link_.send(protocol::EditMessage{.id = ++last_id_, .edit = next()}))
        throw std::runtime_error("an edit could not be sent");
    if (unanswered_ == 0) link_.close();
  }

  void take(const protocol::ServerMessage& message) {
    if (const auto* rejected = std::get_if<protocol::Rejected>(&message))
      throw std::runtime_error(rejected->failure.detail);
    if (!std::holds_alternative<protocol::Applied>(message)) return;
    --unanswered_;
    send();
  }

  std::mt19937_64 random_{7};
  double side_;
  std::size_t left_, unanswered_ = 0, edits_ = 0;
  protocol::MessageId last_id_ = 0;
  link::EventLoop loop_;
  link::Link link_;
};

struct Joining {
  double from_connecting_ms = 0, from_view_ms = 0, bytes = 0, chunks = 0;
};

/// Joins once, with this view.
class Joiner {
 public:
  Joiner(const link::ServerAddress& server, const std::string& map,
         const std::optional<protocol::MapRect>& rect)
      : link_(loop_, {.server = server, .hello = hello(), .map = map},
              {.ready = [this, rect] { look(rect); },
               .message = [this](const auto& message) { take(message); },
               .frame = [this](auto& events, std::size_t bytes) { take(events, bytes); },
               .closed = [this](const auto&) { loop_.stop(); }}) {
    loop_.run();
    if (!done_) throw std::runtime_error("the view did not arrive");
  }
  const Joining& result() const { return result_; }

 private:
  static double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  }

  void look(const std::optional<protocol::MapRect>& rect) {
    looked_ = Clock::now();
    if (!link_.send(protocol::View{.n = 1, .rect = rect, .have = {}, .id = {}})) link_.close();
  }

  void take(const protocol::ServerMessage& message) {
    if (const auto* joined = std::get_if<protocol::Joined>(&message))
      scene_.join(protocol::parse_hex(joined->epoch).value(), joined->seq);
    if (!std::holds_alternative<protocol::CaughtUp>(message)) return;
    done_ = true;
    result_ = {.from_connecting_ms = ms_since(started_),
               .from_view_ms = ms_since(looked_),
               .bytes = static_cast<double>(scene_.stats().bytes),
               .chunks = static_cast<double>(scene_.stats().chunks)};
    link_.close();
  }

  void take(std::vector<protocol::FrameEvent>& events, std::size_t bytes) {
    if (const auto taken = scene_.take(events, bytes); !taken)
      throw std::runtime_error(taken.error().detail);
  }

  Joining result_;
  bool done_ = false;
  scene::Scene scene_;
  Clock::time_point started_ = Clock::now(), looked_;
  link::EventLoop loop_;
  link::Link link_;
};

/// Waits until every mesh is up to date: what is measured is joining, not meshing.
void settle(const link::ServerAddress& server, const std::string& map) {
  const auto answer =
      link::http_get(server, "/api/maps/" + map + "/figures", {.timeout = std::chrono::minutes(5)});
  if (!answer || answer->status != 200) throw std::runtime_error("no figures of " + map);
}

double median(const std::vector<Joining>& joinings, double Joining::*figure) {
  std::vector<double> values;
  for (const Joining& joining : joinings) values.push_back(joining.*figure);
  return percentile(values, 0.5);
}

void measure(const BenchServer& bench, const std::string& map, double side, int reps) {
  const link::ServerAddress server{.host = "127.0.0.1", .port = bench.port()};
  if (const auto made = link::create_map(server, map, {}); !made)
    throw std::runtime_error(made.error().detail);
  { const Ground ground(server, map, side); }
  settle(server, map);

  const double low = (side - kViewSide) / 2, high = low + kViewSide;
  std::optional<protocol::MapRect> view;  // none: everything
  if (side > kViewSide) view = protocol::MapRect{.x0 = low, .y0 = low, .x1 = high, .y1 = high};
  std::vector<Joining> joinings;
  for (int i = 0; i <= reps; ++i) {
    const Joining joining = Joiner(server, map, view).result();
    if (i > 0) joinings.push_back(joining);
  }
  std::vector<double> all;
  for (const Joining& joining : joinings) all.push_back(joining.from_connecting_ms);
  const nlohmann::ordered_json line{
      {"tool", "earthwork"},
      {"data", "view of 1024 x 1024 into " + std::to_string(std::lround(side)) + " x " +
                   std::to_string(std::lround(side)) + " voxels"},
      {"reps", reps},
      {"join_ms", median(joinings, &Joining::from_connecting_ms)},
      {"join_min_ms", *std::min_element(all.begin(), all.end())},
      {"join_max_ms", *std::max_element(all.begin(), all.end())},
      {"view_ms", median(joinings, &Joining::from_view_ms)},
      {"bytes", median(joinings, &Joining::bytes)},
      {"chunks", median(joinings, &Joining::chunks)},
      {"server_memory_bytes", bench.process().memory_bytes()}};
  std::cout << line.dump() << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view text = argc == 2 ? argv[1] : "";
  if (text == "--help") return std::fputs(kUsage, stdout), 0;
  int reps = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), reps);
  if (read.ec != std::errc{} || read.ptr != text.data() + text.size() || reps < 1 || reps > 1000)
    return std::fputs(kUsage, stderr), 2;
  try {
    const BenchServer server;
    measure(server, "small", kViewSide, reps);
    measure(server, "large", 16 * kViewSide, reps);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "earthwork-join: %s\n", error.what());
    return 2;
  }
}
