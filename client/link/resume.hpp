/// How a client goes on with a map when its connection was lost: what to say again, whether to try
/// again, and when.
///
/// It decides and does nothing: no socket, no clock of its own. `Membership` is the one that does,
/// natively; a browser's viewer does the same with its own socket.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/link/backoff.hpp"
#include "client/link/closing.hpp"
#include "client/link/unanswered.hpp"
#include "protocol/messages.hpp"

namespace earthwork::link {

/// A joined connection that was of no use counts as one once it lasted so long.
inline constexpr std::chrono::seconds kProvenAfter{5};

/// What a server that cannot be reached at the very first try means.
enum class FirstTry { must_reach, may_fail };

struct ResumeOptions {
  protocol::Hello hello;          ///< With the key of an earlier time, or without one.
  protocol::MessageId last_id{};  ///< The largest that was ever used with that key in this map.
  /// Without a useful connection for so long it gives up; none: never.
  std::optional<std::chrono::milliseconds> patience = std::chrono::seconds(60);
  FirstTry first_try = FirstTry::must_reach;
};

enum class Fate {
  applied,
  rejected,
  lost,  ///< Whether it was applied is not known, and it is not sent again.
};

/// What became of an edit.
struct Answer {
  protocol::MessageId id = 0;
  Fate fate = Fate::lost;
  std::uint64_t seq = 0;  ///< Of one that was applied.
  protocol::Failure why;  ///< Of one that was not.
};

enum class Joining {
  first,
  again,
  another_map,  ///< One of the same name, made since: its epoch is another.
};

/// Feed it what happens, in order: welcome, joined, then messages and frames, then the end of the
/// connection; and again. Edits and views may be asked for at any time.
class Resume {
 public:
  using Time = std::chrono::steady_clock::time_point;

  Resume(ResumeOptions options, std::uint64_t seed, Time now);

  /// For the next connection: with the key that the first welcome gave.
  [[nodiscard]] const protocol::Hello& hello() const { return options_.hello; }

  /// Gives it the next id and keeps it until it is answered. What comes back is the id and the
  /// message to be sent, now or with `opening`. Fails as `Unanswered::add` does.
  [[nodiscard]] protocol::Result<Unanswered::Kept> add(const protocol::Edit& edit) {
    return unanswered_.add(edit);
  }
  [[nodiscard]] protocol::Result<Unanswered::Kept> add(const protocol::LayerChange& change) {
    return unanswered_.add(change);
  }
  /// The view to ask for from now on. What comes back is the message to be sent when a map is
  /// joined; `opening` has it otherwise.
  [[nodiscard]] std::string look(const protocol::View& view);

  void take_welcome(const protocol::Welcome& welcome);
  struct Entrance {
    Joining joining = Joining::first;
    std::vector<Answer> lost;  ///< Edits of the map that is gone.
  };
  [[nodiscard]] Entrance take_joined(const protocol::Joined& joined, Time now);
  /// A view was asked for, so that what the viewer has may be claimed.
  [[nodiscard]] bool looks() const { return view_.has_value(); }
  /// What to say first on a connection that has joined: the view with its claim, then every edit
  /// that is unanswered, in order.
  [[nodiscard]] std::vector<std::string> opening(std::optional<protocol::Have> have) const;
  /// Any message of a connection that has joined. The answer to an edit comes back, once.
  [[nodiscard]] std::optional<Answer> take(const protocol::ServerMessage& message);
  /// A binary message came.
  void take_frame() { useful_ = true; }
  /// The connection is no more. When to try again, or nothing: never.
  [[nodiscard]] std::optional<std::chrono::milliseconds> take_end(const Closing& closing, Time now);
  /// What was not answered is lost.
  [[nodiscard]] std::vector<Answer> give_up(const protocol::Failure& why);

  [[nodiscard]] const Unanswered& unanswered() const { return unanswered_; }

 private:
  ResumeOptions options_;
  Backoff backoff_;
  Unanswered unanswered_;
  std::optional<protocol::View> view_;
  std::optional<std::string> epoch_;         // of the map that was joined
  std::chrono::milliseconds asked_delay_{};  // by the bye of this connection
  std::optional<Time> joined_at_;            // this connection
  bool reached_ = false;                     // there was a welcome, ever
  bool useful_ = false;                      // this connection brought something that was asked for
  Time away_since_;                          // the end of the last useful connection, or the start
};

}  // namespace earthwork::link
