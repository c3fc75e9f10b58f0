/// Who is at a map, as far as edits go: what each viewer is still to be told, and who leaves when
/// it was told.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "protocol/messages.hpp"
#include "protocol/result.hpp"
#include "server/room/guarded_viewer.hpp"
#include "server/room/held_answers.hpp"
#include "server/room/viewer.hpp"

namespace earthwork::room {

/// On the strand of the room whose part it is. Nothing here happens for nobody.
class Seats {
 public:
  void enter(ViewerId id, std::shared_ptr<GuardedViewer> viewer);
  void leave(ViewerId id) { seats_.erase(id); }
  [[nodiscard]] bool contains(ViewerId id) const { return seats_.contains(id); }
  [[nodiscard]] std::size_t size() const { return seats_.size(); }
  [[nodiscard]] bool empty() const { return seats_.empty(); }

  /// The viewer is owed one more answer.
  void owe_answer(ViewerId id);
  /// That is one of those: true, and to be told, once event `seq` is durable.
  void answer(ViewerId id, Reply reply, std::uint64_t seq);
  /// No answer that waits for an event after `durable_seq` will be true: those edits are refused.
  void refuse_answers(std::uint64_t durable_seq, const protocol::Failure& why);
  /// Tells everybody what is durable.
  void tell_answers(std::uint64_t durable_seq);

  /// Tells everybody who does not leave the map's settings, as one `settings` message.
  void tell_settings(const SharedText& message);

  /// False when the viewer is owed no answer. Else `gone` is kept for when it is owed none.
  [[nodiscard]] bool leaves_when_told(ViewerId id, std::function<void()> gone);
  struct Leaver {
    ViewerId id = 0;
    std::shared_ptr<GuardedViewer> viewer;
    std::function<void()> gone;  ///< May be none.
  };
  /// Takes out who wanted to leave and is owed no answer, and whoever is broken.
  [[nodiscard]] std::vector<Leaver> take_leavers();

  /// Nobody is here any more, and everybody is told.
  void end(const protocol::Bye& bye);

 private:
  struct Seat {
    std::shared_ptr<GuardedViewer> viewer;
    std::size_t owed = 0;  // answers, of edits in line too
    HeldAnswers held;
    std::function<void()> gone;  // set: it leaves when nothing is owed
  };

  std::map<ViewerId, Seat> seats_;
};

}  // namespace earthwork::room
