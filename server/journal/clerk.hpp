/// Where a journal's work is done: one task after the other, beside the map that goes on.
#pragma once

#include <functional>
#include <memory>

#include "server/journal/journal.hpp"

namespace earthwork::journal {

/// `now` tasks run in the order in which they were posted, before any `idle` one that waits; idle
/// tasks too keep their order among themselves.
enum class Urgency { now, idle };

/// Any thread may post. What is posted runs once; the end of the clerk waits for it, and then the
/// journal is closed. A task must not throw, and may outlive whoever posted it.
class Clerk {
 public:
  using Task = std::function<void(Journal& journal)>;

  virtual ~Clerk() = default;
  virtual void post(Urgency urgency, Task task) = 0;
};

/// Runs tasks on a thread of its own.
[[nodiscard]] std::unique_ptr<Clerk> hire_clerk(std::unique_ptr<Journal> journal);
/// Runs each task within the call that posts it: for a journal that never waits. Calls come from
/// one thread at a time, and none from within a task.
[[nodiscard]] std::unique_ptr<Clerk> immediate_clerk(std::unique_ptr<Journal> journal);

}  // namespace earthwork::journal
