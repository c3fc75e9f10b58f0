// A room as a server runs it: its strand on a pool of threads, its clerk on one of its own.
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <future>
#include <memory>
#include <vector>

#include "server/history/fold.hpp"
#include "server/journal/memory_journal.hpp"
#include "server/room/asio_strand.hpp"
#include "server/room/room.hpp"
#include "tests/room/onlooker.hpp"

namespace earthwork::room {
namespace {

using namespace std::chrono_literals;

const journal::Identity kIdentity{
    .settings = {.chunk_resolution = 8, .chunks = {}}, .epoch = 0xABCD, .created_ms = 0};

std::shared_ptr<Room> make_room(boost::asio::thread_pool& pool) {
  auto clerk = journal::hire_clerk(journal::make_memory_journal(kIdentity));
  return std::make_shared<Room>("m", open_empty(kIdentity, std::move(clerk), Commits::later),
                                make_asio_strand(pool.get_executor()), std::make_shared<Meters>());
}

/// Counts what it is told, on the room's strand, and asks for more.
struct Eager final : Viewer {
  Eager(Room& its_room, std::size_t wanted) : room(its_room), wanted_acks(wanted) {}
  void answered(std::vector<Reply> replies) override {
    acks += replies.size();
    if (acks == wanted_acks) told.set_value();
  }
  void deliver(Parcel) override {
    room.strand().post([this, alive = room.weak_from_this()] {
      if (const auto live = alive.lock()) live->ready(id);
    });
  }
  void tell(Talk) override {}
  void settings(SharedText) override {}
  void end(protocol::Bye) override {}

  Room& room;
  const std::size_t wanted_acks;
  std::size_t acks = 0;
  ViewerId id = 0;
  std::promise<void> told;
};

TEST(RoomThreads, EveryEditIsAnswered) {
  boost::asio::thread_pool pool(2);
  const auto room = make_room(pool);
  std::vector<std::shared_ptr<Eager>> editors;
  for (std::uint64_t author = 1; author <= 4; ++author) {
    editors.push_back(std::make_shared<Eager>(*room, 500));
    room->strand().post([room, eyes = editors.back()] {
      eyes->id = room->join(eyes, {}).value().viewer;
      ASSERT_TRUE(room->look(eyes->id, view_all(1)));
    });
    for (protocol::MessageId id = 1; id <= 500; ++id)
      room->strand().post([room, author, id, eyes = editors.back()] {
        const double x = static_cast<double>(id % 90), y = static_cast<double>(10 * author);
        ASSERT_TRUE(room->submit(eyes->id, {id, author, disc(x, y, 3, id % 3 != 0)}));
      });
  }
  for (const auto& editor : editors)
    ASSERT_EQ(editor->told.get_future().wait_for(60s), std::future_status::ready);
  std::promise<RoomInfo> info;
  room->strand().post([&] { info.set_value(room->info()); });
  EXPECT_EQ(info.get_future().get().seq, 2000u);
  pool.join();
}

TEST(RoomThreads, ARoomMayBeLetGoOfWhileItsClerkIsAtWork) {
  boost::asio::thread_pool pool(2);
  std::vector<std::weak_ptr<Room>> rooms;
  for (int i = 0; i < 100; ++i) {
    auto room = make_room(pool);
    rooms.push_back(room);
    const auto eyes = std::make_shared<Eager>(*room, 1000);
    room->strand().post([room, eyes] {
      eyes->id = room->join(eyes, {}).value().viewer;
      for (protocol::MessageId id = 1; id <= 20; ++id)
        ASSERT_TRUE(room->submit(eyes->id, {id, 7, disc(static_cast<double>(id), 4, 3)}));
    });
  }
  pool.join();
  for (const auto& room : rooms) EXPECT_TRUE(room.expired());
}

TEST(RoomThreads, ARetiredRoomClosesItsJournal) {
  boost::asio::thread_pool pool(2);
  const auto room = make_room(pool);
  const auto eyes = std::make_shared<Eager>(*room, 20);
  std::promise<void> closed;
  room->strand().post([room, eyes] {
    eyes->id = room->join(eyes, {}).value().viewer;
    for (protocol::MessageId id = 1; id <= 20; ++id)
      ASSERT_TRUE(room->submit(eyes->id, {id, 7, disc(static_cast<double>(id), 4, 3)}));
  });
  ASSERT_EQ(eyes->told.get_future().wait_for(60s), std::future_status::ready);
  room->strand().post([room, eyes, &closed] {
    room->leave(eyes->id);
    EXPECT_TRUE(room->retire([&closed] { closed.set_value(); }));
  });
  EXPECT_EQ(closed.get_future().wait_for(60s), std::future_status::ready);
  pool.join();
}

}  // namespace
}  // namespace earthwork::room
