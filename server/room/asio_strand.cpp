#include "server/room/asio_strand.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <chrono>
#include <exception>

namespace earthwork::room {
namespace {

namespace asio = boost::asio;

// An exception must not reach the threads of the pool: it would end the process, and with it what
// everybody else does.
void run_alone(const Strand::Task& task) {
  try {
    task();
  } catch (const std::exception& error) {
    spdlog::error("a task failed: {}", error.what());
  } catch (...) {
    spdlog::error("a task failed");
  }
}

class AsioStrand final : public Strand {
 public:
  AsioStrand(asio::any_io_executor serial, asio::any_io_executor beside)
      : serial_(std::move(serial)), beside_(std::move(beside)) {}

  void post(Task task) override {
    asio::post(serial_, [run = std::move(task)] { run_alone(run); });
  }

  void post_aside(Task task) override {
    asio::post(beside_, [run = std::move(task)] { run_alone(run); });
  }

  void post_after(std::chrono::milliseconds delay, Task task) override {
    // The handler keeps its own timer alive.
    auto timer = std::make_shared<asio::steady_timer>(serial_, delay);
    timer->async_wait([timer, run = std::move(task)](const boost::system::error_code& error) {
      if (!error) run_alone(run);
    });
  }

  [[nodiscard]] std::int64_t now_ms() const override {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
  }

 private:
  asio::any_io_executor serial_, beside_;
};

}  // namespace

std::unique_ptr<Strand> make_asio_strand(const asio::any_io_executor& executor) {
  return std::make_unique<AsioStrand>(asio::make_strand(executor), executor);
}

std::unique_ptr<Strand> wrap_serial_executor(const asio::any_io_executor& executor) {
  return std::make_unique<AsioStrand>(executor, executor);
}

}  // namespace earthwork::room
