#include "client/bot/load_run.hpp"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <vector>

#include "client/bot/load_loop.hpp"
#include "client/link/http_client.hpp"
#include "protocol/json_fields.hpp"
#include "protocol/json_text.hpp"

namespace earthwork::bot {
namespace {

using namespace std::chrono_literals;
using protocol::Failure;

constexpr auto kLook = 10ms;
// Each may take so long; the slow viewer's socket may hold a minute of its reading.
constexpr auto kGathering = 120s, kAnswering = 30s, kSettling = 120s;
constexpr std::size_t kSampledViewers = 16;
constexpr std::uint64_t kViewerSeeds = 1'000'000;  // apart from those of the walks
constexpr std::size_t kMaxFiguresBytes = 64 * 1024;

/// Leads the loops from phase to phase, on the calling thread.
class LoadRun {
 public:
  LoadRun(const LoadPlan& plan, std::ostream& log) : plan_(plan), log_(log), timer_(loop_) {
    std::vector<std::vector<EditorPlan>> editors(plan.threads);
    std::vector<std::vector<ViewerPlan>> viewers(plan.threads);
    for (std::size_t i = 0; i < plan.editors; ++i)
      editors[i % plan.threads].push_back(editor_plan(i));
    for (std::size_t i = 0; i < plan.viewers; ++i)
      viewers[i % plan.threads].push_back(viewer_plan(i));
    for (std::size_t i = 0; i < plan.threads; ++i)
      loops_.push_back(std::make_unique<LoadLoop>(editors[i], viewers[i], board_));
  }

  LoadReport run() {
    const link::SignalWatch signals(loop_, [this] { interrupt(); });
    phase_since_ = LoadClock::now();
    for (const auto& loop : loops_) loop->run();
    look();
    loop_.run();
    board_.phase = LoadPhase::over;
    for (const auto& loop : loops_) loop->join();
    tell_lines();
    gather_report();
    return std::move(report_);
  }

 private:
  EditorPlan editor_plan(std::size_t index) const {
    EditorPlan out{.server = plan_.server,
                   .map = plan_.map,
                   .square = plan_.square,
                   .radius = plan_.radius,
                   .seed = plan_.seed + index,
                   .edits_per_second = plan_.edits_per_second};
    if (plan_.edits_per_second) {
      const double share = static_cast<double>(index) / static_cast<double>(plan_.editors);
      const std::chrono::duration<double> delay(share / *plan_.edits_per_second);
      out.delay = std::chrono::duration_cast<std::chrono::nanoseconds>(delay);
    }
    return out;
  }

  ViewerPlan viewer_plan(std::size_t index) const {
    const std::size_t bad = plan_.slow + plan_.stalled + plan_.flaky;
    const std::chrono::duration<double> painting(plan_.seconds);
    return {.server = plan_.server,
            .map = plan_.map,
            .manner = manner_of(plan_, index),
            .seed = plan_.seed + kViewerSeeds + index,
            .sampled = index >= bad && index < bad + kSampledViewers,
            .painting = std::chrono::duration_cast<std::chrono::nanoseconds>(painting)};
  }

  void look() {
    tell_lines();
    if (board_.failure()) return loop_.stop();
    advance();
    if (phase_ == LoadPhase::over) return loop_.stop();
    timer_.start(kLook, [this] { look(); });
  }

  void advance() {
    const auto spent = LoadClock::now() - phase_since_;
    switch (phase_) {
      case LoadPhase::gathering:
        if (all_done()) return enter(LoadPhase::painting);
        if (spent > kGathering) give_up("not everybody has joined and seen all of the map");
        return;
      case LoadPhase::painting:
        if (report_.interrupted || spent >= std::chrono::duration<double>(plan_.seconds)) {
          report_.seconds = std::chrono::duration<double>(spent).count();
          enter(LoadPhase::answering);
        }
        return;
      case LoadPhase::answering:
        if (spent > kAnswering) log_ << "not every edit is answered\n";
        if (all_done() || spent > kAnswering) enter(LoadPhase::settling);
        return;
      case LoadPhase::settling:
        if (all_done()) return enter(LoadPhase::over);
        if (spent > kSettling) give_up("not every viewer shows the last edit");
        return;
      case LoadPhase::over:
        return;
    }
  }

  bool all_done() const {
    return std::all_of(loops_.begin(), loops_.end(),
                       [this](const auto& loop) { return loop->done(phase_); });
  }

  void enter(LoadPhase phase) {
    report_.painted = report_.painted || phase == LoadPhase::painting;
    phase_ = phase;
    phase_since_ = LoadClock::now();
    if (phase != LoadPhase::over) board_.phase = phase;
  }

  void give_up(const char* why) {
    log_ << why << '\n';
    phase_ = LoadPhase::over;
  }

  void interrupt() {
    if (report_.interrupted || phase_ == LoadPhase::gathering) phase_ = LoadPhase::over;
    report_.interrupted = true;
    log_ << "interrupted\n";
  }

  void tell_lines() {
    for (const std::string& line : board_.take_lines()) log_ << line << '\n';
  }

  void gather_report() {
    report_.failure = board_.failure();
    report_.seq = board_.last_seq();
    if (const auto picture = map_picture(plan_.server, plan_.map); !picture)
      log_ << picture.error().detail << '\n';
    else if (picture->seq != report_.seq && report_.painted)
      log_ << "somebody else paints too: the map is at seq " << picture->seq << '\n';
    else
      report_.mesh_hash = picture->mesh_hash;
    for (const auto& loop : loops_) add(*loop);
  }

  void add(const LoadLoop& loop) {
    report_.busy = std::max(report_.busy, loop.busy());
    report_.lag.add(loop.lag());
    for (const auto& editor : loop.editors()) {
      const EditorCounts& counts = editor->counts();
      report_.edits += counts.edits;
      report_.acked += counts.acked;
      report_.rejected += counts.rejected;
      report_.ack.add(counts.ack);
      report_.lag.add(counts.lag);
    }
    for (const auto& viewer : loop.viewers()) add(*viewer);
  }

  void add(const LoadViewer& viewer) {
    const ViewerCounts& counts = viewer.counts();
    report_.frames += counts.frames;
    report_.groups += counts.groups;
    report_.records += counts.records;
    report_.bytes += counts.bytes;
    report_.reconnects += counts.reconnects;
    report_.view.add(counts.view);
    if (viewer.manner() == Manner::healthy) report_.healthy_bytes += counts.bytes;
    Agreement& agreement = of(viewer.manner());
    ++agreement.viewers;
    if (viewer.shows(report_.seq) && viewer.scene().mesh_hash() == report_.mesh_hash)
      ++agreement.agreeing;
  }

  Agreement& of(Manner manner) {
    switch (manner) {
      case Manner::slow:
        return report_.slow;
      case Manner::stalled:
        return report_.stalled;
      case Manner::flaky:
        return report_.flaky;
      case Manner::healthy:
        break;
    }
    return report_.healthy;
  }

  const LoadPlan& plan_;
  std::ostream& log_;
  LoadBoard board_;
  LoadReport report_;
  LoadPhase phase_ = LoadPhase::gathering;
  LoadClock::time_point phase_since_;
  link::EventLoop loop_;
  link::Timer timer_;
  std::vector<std::unique_ptr<LoadLoop>> loops_;
};

}  // namespace

bool LoadReport::all_agree() const {
  const auto agrees = [](const Agreement& those) { return those.agreeing == those.viewers; };
  return mesh_hash && agrees(healthy) && agrees(slow) && agrees(stalled) && agrees(flaky);
}

bool LoadReport::generator_limited() const {
  return busy > kMaxBusy || lag.percentile_ms(99).value_or(0) > kMaxLag_ms;
}

Manner manner_of(const LoadPlan& plan, std::size_t index) {
  if (index < plan.slow) return Manner::slow;
  if (index < plan.slow + plan.stalled) return Manner::stalled;
  if (index < plan.slow + plan.stalled + plan.flaky) return Manner::flaky;
  return Manner::healthy;
}

protocol::Result<MapPicture> map_picture(const link::ServerAddress& server,
                                         const std::string& map) {
  const auto answer = link::http_get(server, "/api/maps/" + map + "/figures");
  if (!answer) return tl::unexpected<Failure>(answer.error());
  const auto document = protocol::parse_json(answer->body, kMaxFiguresBytes);
  if (answer->status != 200 || !document)
    return protocol::fail(protocol::Code::internal, server.text() + " gives no figures of " + map);
  protocol::JsonFields in(*document);
  const auto seq = static_cast<std::uint64_t>(in.integer("seq"));
  const auto hash = protocol::parse_hex(in.hex_digits("mesh_hash", 16));
  MapPicture out{.seq = seq, .mesh_hash = hash.value_or(0)};
  return in.result(std::move(out));
}

LoadReport run_load(const LoadPlan& plan, std::ostream& log) { return LoadRun(plan, log).run(); }

}  // namespace earthwork::bot
