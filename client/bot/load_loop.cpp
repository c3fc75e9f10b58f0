#include "client/bot/load_loop.hpp"

#include <algorithm>
#include <ctime>

namespace earthwork::bot {
namespace {

using namespace std::chrono_literals;

constexpr auto kTick = 5ms;
constexpr std::size_t kConnectingAtATime = 32;

std::chrono::nanoseconds thread_cpu() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace

LoadLoop::LoadLoop(const std::vector<EditorPlan>& editors, const std::vector<ViewerPlan>& viewers,
                   LoadBoard& board)
    : board_(board), timer_(loop_) {
  for (const EditorPlan& plan : editors)
    editors_.push_back(std::make_unique<LoadEditor>(loop_, plan, board));
  for (const ViewerPlan& plan : viewers)
    viewers_.push_back(std::make_unique<LoadViewer>(loop_, plan, board));
}

LoadLoop::~LoadLoop() { join(); }

void LoadLoop::run() {
  due_ = LoadClock::now();
  timer_.start(0ns, [this] { tick(); });
  thread_ = std::thread([this] { loop_.run(); });
}

void LoadLoop::join() {
  if (thread_.joinable()) thread_.join();
}

void LoadLoop::tick() {
  const auto now = LoadClock::now();
  if (phase_ == LoadPhase::painting) lag_.add(now - due_);
  if (const LoadPhase phase = board_.phase; phase != phase_) enter(phase);
  if (phase_ == LoadPhase::over) return loop_.stop();
  if (phase_ == LoadPhase::gathering) connect_some();
  for (const auto& viewer : viewers_) viewer->match_times();
  if (reached(phase_)) done_ = phase_;
  // A tick that was missed is not made up: its lag was counted once.
  due_ = std::max(due_ + kTick, now);
  timer_.start(due_ - now, [this] { tick(); });
}

void LoadLoop::connect_some() {
  const auto is_connecting = [](const auto& viewer) { return viewer->connecting(); };
  auto connecting =
      static_cast<std::size_t>(std::count_if(viewers_.begin(), viewers_.end(), is_connecting));
  for (; connected_ < viewers_.size() && connecting < kConnectingAtATime; ++connecting)
    viewers_[connected_++]->connect();
}

void LoadLoop::enter(LoadPhase phase) {
  const auto now = LoadClock::now();
  if (phase == LoadPhase::painting) {
    painting_since_ = now;
    cpu_before_ = thread_cpu();
    for (const auto& viewer : viewers_) viewer->misbehave();
    for (const auto& editor : editors_) editor->paint();
  } else if (phase_ == LoadPhase::painting) {
    const std::chrono::duration<double> cpu = thread_cpu() - cpu_before_;
    busy_ = cpu / (now - painting_since_);
    for (const auto& editor : editors_) editor->stop();
  }
  if (phase == LoadPhase::settling)
    for (const auto& viewer : viewers_) viewer->let_go();
  phase_ = phase;
}

bool LoadLoop::reached(LoadPhase phase) const {
  const auto all = [](const auto& items, auto is) {
    return std::all_of(items.begin(), items.end(), [&](const auto& item) { return is(*item); });
  };
  if (phase == LoadPhase::gathering)
    return all(editors_, [](const LoadEditor& editor) { return editor.ready(); }) &&
           all(viewers_, [](const LoadViewer& viewer) { return viewer.ready(); });
  if (phase == LoadPhase::answering)
    return all(editors_, [](const LoadEditor& editor) { return editor.answered(); });
  const std::uint64_t last = board_.last_seq();
  return phase == LoadPhase::settling &&
         all(viewers_, [last](const LoadViewer& viewer) { return viewer.shows(last); });
}

}  // namespace earthwork::bot
