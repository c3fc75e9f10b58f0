#include "server/room/manual_context.hpp"

#include <utility>

namespace earthwork::room {

class ManualContext::ManualStrand final : public Strand {
 public:
  explicit ManualStrand(ManualContext& context) : context_(context) {}

  void post(Task task) override { context_.tasks_.push_back(std::move(task)); }
  void post_aside(Task task) override { post(std::move(task)); }
  void post_after(std::chrono::milliseconds delay, Task task) override {
    context_.later_.emplace(context_.now_ + delay, std::move(task));
  }
  [[nodiscard]] std::int64_t now_ms() const override { return context_.now_.count(); }

 private:
  ManualContext& context_;
};

std::unique_ptr<Strand> ManualContext::make_strand() {
  return std::make_unique<ManualStrand>(*this);
}

int ManualContext::run(int most) {
  int ran = 0;
  for (; ran < most && !tasks_.empty(); ++ran) {
    const Strand::Task task = std::move(tasks_.front());
    tasks_.pop_front();
    task();
  }
  return ran;
}

void ManualContext::advance(std::chrono::milliseconds time) {
  const auto end = now_ + time;
  run();
  while (!later_.empty() && later_.begin()->first <= end) {
    now_ = later_.begin()->first;
    tasks_.push_back(std::move(later_.begin()->second));
    later_.erase(later_.begin());
    run();
  }
  now_ = end;
}

}  // namespace earthwork::room
