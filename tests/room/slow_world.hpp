/// A world whose commits end when the test says so, and fail when it says so.
#pragma once

#include <memory>
#include <utility>

#include "tests/room/fickle_journal.hpp"
#include "tests/room/manual_clerk.hpp"
#include "tests/room/world.hpp"

namespace earthwork::room {

struct SlowWorld : World {
  explicit SlowWorld(const protocol::MapSettings& settings = kSmallChunks)
      : SlowWorld(std::make_unique<FickleJournal>(identity_of(settings)), settings) {}

  /// The append in flight ends, and whatever else waits for the clerk is done. The strand does not
  /// run.
  void store() { clerk->run(); }
  /// The append in flight ends well, and the room goes on; the next one may be in flight then.
  void commit() {
    store();
    context.run();
  }
  /// The append in flight fails; those after it do not.
  void fail(protocol::Code code = protocol::Code::disk_full) {
    fickle->trouble = protocol::Failure{code, "the disk is full", {}};
    store();
    context.run();
    fickle->trouble.reset();
  }
  /// Until nothing is in flight.
  void commit_all() {
    context.run();
    while (clerk->waiting() > 0) commit();
  }
  /// So that edits are taken again.
  void wait_out_the_pause() { context.advance(std::chrono::milliseconds(kPauseMs)); }

  FickleJournal* fickle = nullptr;  // these two end with the room
  ManualClerk* clerk = nullptr;

 private:
  SlowWorld(std::unique_ptr<FickleJournal> its_journal, const protocol::MapSettings& settings)
      : SlowWorld{its_journal.get(), std::make_unique<ManualClerk>(std::move(its_journal)),
                  settings} {}
  SlowWorld(FickleJournal* its_journal, std::unique_ptr<ManualClerk> its_clerk,
            const protocol::MapSettings& settings)
      : SlowWorld{its_journal, its_clerk.get(),
                  open_empty(identity_of(settings), std::move(its_clerk), Commits::later)} {}
  SlowWorld(FickleJournal* its_journal, ManualClerk* its_clerk, Opening opening)
      : World(std::move(opening), *its_journal), fickle(its_journal), clerk(its_clerk) {}
};

}  // namespace earthwork::room
