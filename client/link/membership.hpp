/// A lasting part in one map: joined over one connection after the other, with no edit lost or done
/// twice when one breaks. `Link` is the single connection, `Resume` decides what to say and when.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "client/link/event_loop.hpp"
#include "client/link/link.hpp"
#include "client/link/resume.hpp"
#include "protocol/result.hpp"

namespace earthwork::link {

struct MembershipOptions {
  ServerAddress server;
  std::string map;
  ResumeOptions resume;
  std::optional<int> receive_buffer_bytes = std::nullopt;  ///< As of SocketOptions.
  std::optional<std::uint64_t> seed = std::nullopt;        ///< Of the delays; random without it.
};

/// Each may be empty. They are called on the loop's thread, never from within a call to the
/// membership, and must not destroy it.
struct MembershipHandlers {
  /// The map was joined. What the owner asks for in here follows what is sent again.
  std::function<void(const protocol::Joined& joined, Joining joining)> joined;
  /// What the viewer has of the map that was just joined; asked after `joined`, if there is a view.
  std::function<std::optional<protocol::Have>()> have;
  /// What became of an edit: exactly once for each.
  std::function<void(const Answer& answer)> answered;
  /// Every control message that arrives, replies to edits too.
  std::function<void(const protocol::ServerMessage& message)> message;
  /// As of LinkHandlers. With each connection the frames begin anew.
  std::function<void(std::vector<protocol::FrameEvent>& events, std::size_t message_bytes)> frame;
  /// There is no connection, and another one is tried in `delay`.
  std::function<void(const Closing& why, std::chrono::milliseconds delay)> lost;
  /// The last call, exactly once; what was not answered was handed back as lost before.
  std::function<void(const Closing& closing)> ended;
};

/// All on the loop's thread.
class Membership {
 public:
  /// Starts to connect; everything further happens while the loop runs.
  Membership(EventLoop& loop, MembershipOptions options, MembershipHandlers handlers);
  Membership(const Membership&) = delete;
  Membership& operator=(const Membership&) = delete;
  /// Cuts the connection without a word; no handler is called any more.
  ~Membership() = default;

  /// Sends an edit, as soon as there is a connection, and gives it its id: 1, 2, 3 ..., or from
  /// `last_id` on. Fails as `Unanswered::add` does, and with bad_state once it is closed.
  [[nodiscard]] protocol::Result<protocol::MessageId> edit(const protocol::Edit& edit);
  /// The same with a change of layers, in the one order of both.
  [[nodiscard]] protocol::Result<protocol::MessageId> edit(const protocol::LayerChange& change);
  /// Asks for this view, now and after every time the map is joined. Its `have` is not used.
  void look(const protocol::View& view);
  /// Sends anything else, which must be without an id, once. Fails with bad_state while no map is
  /// joined, with too_large as `Link::send` does or while the connection is congested.
  [[nodiscard]] protocol::Result<void> send(const protocol::ClientMessage& message);

  [[nodiscard]] bool joined() const { return live_; }
  /// Another edit might be refused; answers tell when to go on.
  [[nodiscard]] bool congested() const { return resume_.unanswered().full(); }
  [[nodiscard]] std::size_t unanswered() const { return resume_.unanswered().edits().size(); }
  /// Said in the next hello: with its key, once there was a welcome.
  [[nodiscard]] const protocol::Hello& hello() const { return resume_.hello(); }

  /// As of Link, for this connection; the next one is read.
  void pause_reading(bool paused);
  /// Ends the connection as a broken network would; another one follows.
  void cut();
  /// Sends what is queued, says goodbye and calls `ended`. No message is handed on any more, and
  /// what is unanswered is lost.
  void close();

 private:
  void connect();
  void take(const protocol::ServerMessage& message);
  void enter();
  protocol::Result<protocol::MessageId> send_kept(const protocol::Result<Unanswered::Kept>& added);
  void say(std::string text);
  void link_closed(const Closing& closing);
  void hand_back(const std::vector<Answer>& answers);
  void end(const Closing& closing);

  EventLoop& loop_;
  const MembershipOptions options_;
  const MembershipHandlers handlers_;
  Resume resume_;
  std::optional<protocol::Joined> joined_;
  bool linked_ = false;   // there is a connection, or one is tried
  bool live_ = false;     // joined, and what is sent again was sent
  bool cutting_ = false;  // the connection is about to be dropped
  bool closing_ = false;  // the owner has closed it, or it has ended
  Timer next_;            // what comes next without a connection
  std::optional<Link> link_;
};

}  // namespace earthwork::link
