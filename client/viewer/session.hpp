/// A person's connection to a map: made, lost, and made again, with nothing said twice or lost.
///
/// `link::Resume` decides what to say and when; this is the part that says it, over a shell's
/// socket and by the time that it is told.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "client/link/resume.hpp"
#include "client/viewer/panel_state.hpp"
#include "client/viewer/shell.hpp"
#include "protocol/frame.hpp"
#include "protocol/limits.hpp"
#include "protocol/messages.hpp"

namespace earthwork::viewer {

/// For each of: the socket's opening, the answer to hello, the answer to join.
inline constexpr std::chrono::seconds kAnswerTimeout{15};
inline constexpr std::chrono::seconds kPingEvery{3};
/// A connection over which nothing came for so long, a ping's answer neither, is no more.
inline constexpr std::chrono::seconds kSilence{15};

/// Ids of messages that are no edits, above all that edits will ever have.
inline constexpr protocol::MessageId kPingId = protocol::kMaxInteger,
                                     kChatId = protocol::kMaxInteger - 1;

/// Whom a session tells, from within its calls. May make edits, look and say things meanwhile.
class SessionOwner {
 public:
  virtual ~SessionOwner() = default;

  /// The map was joined. A view that is asked for in here is said with what `have` claims.
  virtual void joined(const protocol::Joined& joined, link::Joining how) = 0;
  /// What is held of the map that was just joined.
  virtual std::optional<protocol::Have> have() = 0;
  /// Anything but welcome, joined, bye and the answers to edits and pings.
  virtual void told(const protocol::ServerMessage& message) = 0;
  /// What was complete with one binary message; it may be moved from. A failure ends the
  /// connection, and another one follows.
  virtual protocol::Result<void> shown(std::vector<protocol::FrameEvent>& events,
                                       std::size_t message_bytes) = 0;
  /// What became of edits and changes of layers, each once; never of none.
  virtual void answered(const std::vector<link::Answer>& answers) = 0;
};

/// One thread. Never calls the owner from its constructor.
class Session {
 public:
  using Time = std::chrono::steady_clock::time_point;
  struct Options {
    std::string map;
    protocol::Hello hello;
    protocol::MessageId last_id{};
    std::uint64_t seed = 0;
  };

  /// Connects. Both outlive it.
  Session(Shell& shell, SessionOwner& owner, Options options, Time now);

  // What happens to the shell's socket. What does not fit the state of the session is ignored.
  void connected(Time now);
  void text(std::string_view message, Time now);
  void binary(std::span<const std::byte> message, Time now);
  void disconnected(int code, std::string_view reason, Time now);
  void tick(Time now);
  /// When to call `tick` next; nothing once it has ended.
  [[nodiscard]] std::optional<Time> due() const;

  /// Kept until it is answered, and said as soon as there is a connection. Fails as
  /// `link::Unanswered::add` does, and with bad_state once the session has ended.
  [[nodiscard]] protocol::Result<protocol::MessageId> edit(const protocol::Edit& edit);
  [[nodiscard]] protocol::Result<protocol::MessageId> change(const protocol::LayerChange& change);
  /// Asks for this view, now and whenever the map is joined.
  void look(const protocol::View& view);
  /// Said now; false, and not said, while the map is not joined.
  bool say(const protocol::ClientMessage& message);

  /// Leaves for another map. What the old one did not answer is lost.
  void open(std::string map, Time now);
  /// Connects anew as somebody of that name. Edits are kept.
  void be(std::string name, std::string color, Time now);
  /// Connects at once if it waits to, or has ended.
  void retry(Time now);

  [[nodiscard]] bool live() const { return phase_ == Phase::live; }
  [[nodiscard]] const std::string& map() const { return map_; }
  /// Of this connection; empty before its welcome.
  [[nodiscard]] const std::string& id() const { return id_; }
  [[nodiscard]] std::size_t unanswered() const { return resume_.unanswered().edits().size(); }
  [[nodiscard]] std::optional<double> latency_ms() const { return latency_ms_; }
  /// Of all messages that came.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] ConnectionPart part(Time now) const;
  /// When the next connection is tried; none while there is one, or after the end.
  [[nodiscard]] std::optional<Time> retry_at() const;

 private:
  enum class Phase : std::uint8_t { waiting, connecting, greeting, joining, live, ended };

  void connect(Time now);
  void reconnect(Time now);
  bool listening() const;
  void take(const protocol::ServerMessage& message, Time now);
  void take_live(const protocol::ServerMessage& message, Time now);
  void enter(const protocol::Joined& joined, Time now);
  protocol::Result<protocol::MessageId> keep(protocol::Result<link::Unanswered::Kept> kept);
  void hand_back(const std::vector<link::Answer>& answers);
  void watch(Time now);
  /// Closes the socket and goes on as if it had broken.
  void drop(link::CloseCause cause, protocol::Failure failure, Time now);
  void end(const link::Closing& closing, Time now);

  Shell& shell_;
  SessionOwner& owner_;
  std::string map_, name_;
  std::optional<std::string> color_;
  std::uint64_t seed_;
  protocol::MessageId last_id_;
  link::Resume resume_;
  protocol::FrameReader frames_;              // of this connection
  std::vector<protocol::FrameEvent> events_;  // of one message
  Phase phase_ = Phase::waiting;
  bool was_lost_ = false;  // since the map was opened
  std::string words_;      // why there is no connection
  std::string id_;
  Time deadline_{};             // of what the phase waits for; of live: when to watch again
  Time heard_{}, ping_sent_{};  // over this connection
  bool ping_unanswered_ = false;
  std::optional<double> latency_ms_;
  std::uint64_t bytes_ = 0;
};

}  // namespace earthwork::viewer
