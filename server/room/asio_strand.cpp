#include "server/room/asio_strand.hpp"

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <chrono>

namespace earthwork::room {
namespace {

namespace asio = boost::asio;

class AsioStrand final : public Strand {
 public:
  explicit AsioStrand(asio::any_io_executor serial) : serial_(std::move(serial)) {}

  void post(Task task) override { asio::post(serial_, std::move(task)); }

  void post_after(std::chrono::milliseconds delay, Task task) override {
    // The handler keeps its own timer alive.
    auto timer = std::make_shared<asio::steady_timer>(serial_, delay);
    timer->async_wait([timer, run = std::move(task)](const boost::system::error_code& error) {
      if (!error) run();
    });
  }

  [[nodiscard]] std::int64_t now_ms() const override {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
  }

 private:
  asio::any_io_executor serial_;
};

}  // namespace

std::unique_ptr<Strand> make_asio_strand(const asio::any_io_executor& executor) {
  return std::make_unique<AsioStrand>(asio::make_strand(executor));
}

std::unique_ptr<Strand> wrap_serial_executor(const asio::any_io_executor& executor) {
  return std::make_unique<AsioStrand>(executor);
}

}  // namespace earthwork::room
