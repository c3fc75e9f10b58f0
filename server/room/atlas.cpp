#include "server/room/atlas.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <utility>

#include "server/room/aside_queue.hpp"
#include "server/room/atlas_page.hpp"
#include "server/room/room_maker.hpp"

namespace earthwork::room {
namespace {

using namespace std::chrono_literals;
using protocol::Code;
using protocol::Failure;
using RoomPointer = std::shared_ptr<Room>;

tl::unexpected<Failure> unknown(const std::string& name) {
  return protocol::fail(Code::unknown_map, "map: there is no " + name, "map");
}

tl::unexpected<Failure> ending() { return protocol::fail(Code::shutting_down, "the server ends"); }

/// For a client it is the map that this server does not offer, not a version of the protocol.
Failure as_told(Failure failure) {
  if (failure.code == Code::bad_version) failure.code = Code::not_supported;
  return failure;
}

}  // namespace

/// All under one lock, which is held while pages change and never while anything is called.
class Atlas::Core : public std::enable_shared_from_this<Core> {
 public:
  explicit Core(AtlasOptions options);

  protocol::Result<void> take_stock();
  void create(const std::string& name, const protocol::MapSettings& settings, Opened done);
  void open(const std::string& name, Errand errand, Opened done);
  void erase(const std::string& name, Erased done);
  std::vector<MapName> list() const;
  std::vector<RoomPointer> rooms() const;
  /// How a room came to be closed.
  enum class By { itself, sweep };
  void let_go(const Room& room, By whom);
  bool stop(std::chrono::milliseconds patience);
  void part();
  void sweep_later();

  const std::shared_ptr<Meters> meters;

 private:
  /// What is to be called when the lock is no longer held.
  using After = std::vector<std::function<void()>>;
  template <class Act>
  void in_turn(Act act) {
    After after;
    {
      const std::lock_guard lock(mutex_);
      act(after);
    }
    for (const auto& call : after) call();
  }
  template <class Done, class Answer>
  static void answer(After& after, Done done, Answer with) {
    after.push_back([done = std::move(done), with = std::move(with)] { done(with); });
  }
  template <class Answer>
  static void answer_all(After& after, std::vector<Opened>& waiting, const Answer& with) {
    for (Opened& done : std::exchange(waiting, {})) answer(after, std::move(done), with);
  }

  Page* find(const std::string& name);
  void start_opening(const std::string& name, Page& page,
                     std::optional<protocol::MapSettings> settings, After& after);
  void make(const std::string& name, std::uint64_t opening,
            const std::optional<protocol::MapSettings>& settings,
            const std::shared_ptr<ChatLog>& chat);
  void opened(const std::string& name, Page& page, const RoomMaker::Furnished& map, After& after);
  void not_opened(const std::string& name, Page& page, const Failure& why, After& after);
  using CloseRoom = void(const RoomMaker::Furnished&, const Failure&);
  static void close(Page& page, CloseRoom* how, const Failure& why, After& after);
  void take_back(const std::string& name, std::uint64_t opening,
                 std::unique_ptr<journal::Clerk> clerk);
  void closed(const std::string& name, std::uint64_t opening);
  void start_removing(const std::string& name, Page& page, After& after);
  void remove(const std::string& name);
  void sweep();
  void count(const Failure& failure);
  bool over() const;

  const std::shared_ptr<journal::Shelf> shelf_;
  const bool kept_;
  const std::chrono::milliseconds idle_;
  const std::unique_ptr<Strand> strand_;  // for the time; null where maps are not kept
  const std::shared_ptr<AsideQueue> queue_;
  RoomMaker maker_;
  const std::shared_ptr<ChatArchive> archive_ = std::make_shared<ChatArchive>();

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Page, std::less<>> pages_;
  std::uint64_t last_opening_ = 0;
  bool stopping_ = false, over_ = false;
};

Atlas::Core::Core(AtlasOptions options)
    : meters(options.meters),
      shelf_(options.shelf),
      kept_(shelf_->kept()),
      idle_(options.idle),
      strand_(kept_ ? options.make_strand() : nullptr),
      queue_(std::make_shared<AsideQueue>(
          kept_ ? options.aside : [](const Strand::Task& task) { task(); }, kMaxMapsUnderWay)),
      maker_(options.make_strand, shelf_, meters) {}

protocol::Result<void> Atlas::Core::take_stock() {
  auto names = shelf_->names();
  if (!names) return tl::unexpected<Failure>(std::move(names.error()));
  const std::lock_guard lock(mutex_);
  for (const std::string& name : *names) pages_[name];
  return {};
}

void Atlas::Core::create(const std::string& name, const protocol::MapSettings& settings,
                         Opened done) {
  in_turn([&](After& after) {
    const auto refuse = [&](Code code, std::string why, std::string field) {
      answer(after, std::move(done), protocol::fail(code, std::move(why), std::move(field)));
    };
    if (!protocol::valid_map_name(name))
      return refuse(Code::bad_name, "name: 1 to 64 of a-z, 0-9, '-', '_'", "name");
    if (stopping_) return answer(after, std::move(done), ending());
    if (pages_.contains(name))
      return refuse(Code::map_exists, "name: there is a map named " + name, "name");
    if (pages_.size() >= kMaxMaps)
      return refuse(Code::too_large,
                    "the server has " + std::to_string(kMaxMaps) + " maps, its most", {});
    Page& page = pages_[name];
    page.waiting.push_back(std::move(done));
    start_opening(name, page, settings, after);
  });
}

void Atlas::Core::open(const std::string& name, Errand errand, Opened done) {
  in_turn([&](After& after) {
    Page* page = find(name);
    if (page == nullptr) return answer(after, std::move(done), unknown(name));
    if (stopping_) return answer(after, std::move(done), ending());
    page->visited |= errand == Errand::visit;
    if (page->state == Page::State::live) return answer(after, std::move(done), page->room);
    const bool closed = page->state == Page::State::closed;
    if (closed && page->trouble && strand_->now_ms() < page->trouble_until_ms)
      return answer(after, std::move(done), tl::unexpected<Failure>(*page->trouble));
    page->waiting.push_back(std::move(done));
    if (closed) start_opening(name, *page, {}, after);
  });
}

void Atlas::Core::erase(const std::string& name, Erased done) {
  in_turn([&](After& after) {
    Page* page = find(name);
    if (page == nullptr)
      return answer(after, std::move(done), protocol::Result<void>(unknown(name)));
    page->erasing = std::move(done);
    answer_all(after, page->waiting, unknown(name));
    if (page->state == Page::State::live)
      close(*page, close_later, {Code::unknown_map, "the map was deleted", "map"}, after);
    else if (page->state == Page::State::closed)
      start_removing(name, *page, after);
  });
}

/// Null for a map that is being deleted, too.
Page* Atlas::Core::find(const std::string& name) {
  const auto found = pages_.find(name);
  return found == pages_.end() || found->second.erasing ? nullptr : &found->second;
}

void Atlas::Core::start_opening(const std::string& name, Page& page,
                                std::optional<protocol::MapSettings> settings, After& after) {
  page.state = Page::State::opening;
  page.opening = ++last_opening_;
  if (!page.chat) page.chat = std::make_shared<ChatLog>(archive_);
  after.push_back(
      [this, name, opening = page.opening, settings = std::move(settings), chat = page.chat] {
        queue_->post([self = shared_from_this(), name, opening, settings, chat] {
          self->make(name, opening, settings, chat);
        });
      });
}

void Atlas::Core::make(const std::string& name, std::uint64_t opening,
                       const std::optional<protocol::MapSettings>& settings,
                       const std::shared_ptr<ChatLog>& chat) {
  const auto made =
      maker_.make(name, settings, chat,
                  [weak = weak_from_this(), name, opening](std::unique_ptr<journal::Clerk> clerk) {
                    if (const auto self = weak.lock())
                      self->take_back(name, opening, std::move(clerk));
                  });
  in_turn([&](After& after) {
    Page& page = pages_.at(name);
    if (made.map) return opened(name, page, *made.map, after);
    const Failure why = as_told(made.map.error());
    if (made.on_shelf && kept_) return not_opened(name, page, why, after);
    count(why);
    answer_all(after, page.waiting, tl::unexpected<Failure>(why));
    if (page.erasing) answer(after, page.erasing, protocol::Result<void>(unknown(name)));
    pages_.erase(name);
    changed_.notify_all();
  });
}

void Atlas::Core::opened(const std::string& name, Page& page, const RoomMaker::Furnished& map,
                         After& after) {
  page.state = Page::State::live;
  page.room = map.room;
  page.lease = map.lease;
  page.epoch = map.room->epoch();
  page.trouble.reset();
  answer_all(after, page.waiting, protocol::Result<RoomPointer>(map.room));
  if (page.erasing)
    close(page, close_later, {Code::unknown_map, "the map was deleted", "map"}, after);
  else if (stopping_)
    close(page, flush_and_close, ending().value(), after);
  else
    spdlog::debug("map {}: open", name);
}

void Atlas::Core::not_opened(const std::string& name, Page& page, const Failure& why,
                             After& after) {
  page.state = Page::State::closed;
  page.visited = false;
  if (why.code != Code::map_exists) {  // a file that came here while the server ran
    count(why);
    if (page.trouble != why)
      after.push_back([name, why] { spdlog::error("map {} is not served: {}", name, why.detail); });
    page.trouble = why;
    page.trouble_until_ms = strand_->now_ms() + std::chrono::milliseconds(kTroublePause).count();
  }
  answer_all(after, page.waiting, tl::unexpected<Failure>(why));
  if (page.erasing) start_removing(name, page, after);
  changed_.notify_all();
}

// From here on whoever asks waits until the journal is closed.
void Atlas::Core::close(Page& page, CloseRoom* how, const Failure& why, After& after) {
  after.push_back([map = page.take_room(), how, why] { how(map, why); });
}

// Called wherever the room let go of its clerk, on a strand as a rule.
void Atlas::Core::take_back(const std::string& name, std::uint64_t opening,
                            std::unique_ptr<journal::Clerk> clerk) {
  if (over()) {  // nothing runs aside any more
    clerk.reset();
    return closed(name, opening);
  }
  const auto held = std::make_shared<std::unique_ptr<journal::Clerk>>(std::move(clerk));
  queue_->post([self = shared_from_this(), name, opening, held] {
    held->reset();
    self->closed(name, opening);
  });
}

void Atlas::Core::closed(const std::string& name, std::uint64_t opening) {
  in_turn([&](After& after) {
    const auto found = pages_.find(name);
    if (found == pages_.end() || found->second.opening != opening) return;
    Page& page = found->second;
    if (page.state != Page::State::live && page.state != Page::State::closing) return;
    after.push_back([gone = page.take_room()] {});
    page.lease.reset();
    page.state = Page::State::closed;
    changed_.notify_all();
    if (page.erasing) return start_removing(name, page, after);
    if (!kept_ || stopping_) {
      answer_all(after, page.waiting, stopping_ ? ending() : unknown(name));
      if (!kept_) pages_.erase(found);
      return;
    }
    page.visited &= !page.waiting.empty();
    if (!page.waiting.empty()) start_opening(name, page, {}, after);
  });
}

void Atlas::Core::start_removing(const std::string& name, Page& page, After& after) {
  if (over_)  // it stays, for nothing runs aside any more
    return answer(after, std::exchange(page.erasing, nullptr), protocol::Result<void>(ending()));
  page.state = Page::State::removing;
  after.push_back(
      [this, name] { queue_->post([self = shared_from_this(), name] { self->remove(name); }); });
}

void Atlas::Core::remove(const std::string& name) {
  auto removed = shelf_->remove(name);
  in_turn([&](After& after) {
    Page& page = pages_.at(name);
    auto done = std::exchange(page.erasing, nullptr);
    page.state = Page::State::closed;
    if (!removed && removed.error().code != Code::unknown_map) {
      count(removed.error());
      after.push_back([name, why = removed.error()] {
        spdlog::error("map {} was not removed: {}", name, why.detail);
      });
    } else {
      removed = {};
      pages_.erase(name);
    }
    answer(after, std::move(done), removed);
    changed_.notify_all();
  });
}

std::vector<Atlas::MapName> Atlas::Core::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<MapName> names;
  names.reserve(pages_.size());
  for (const auto& [name, page] : pages_)
    if (!page.erasing) names.push_back({name, page.epoch});
  return names;
}

std::vector<RoomPointer> Atlas::Core::rooms() const {
  const std::lock_guard lock(mutex_);
  std::vector<RoomPointer> live;
  for (const auto& [name, page] : pages_)
    if (page.state == Page::State::live) live.push_back(page.room);
  return live;
}

void Atlas::Core::sweep_later() {
  if (!kept_) return;
  const auto pause = std::clamp<std::chrono::milliseconds>(idle_ / 4, 50ms, 2s);
  strand_->post_after(pause, [weak = weak_from_this()] {
    const auto self = weak.lock();
    if (!self) return;
    self->sweep_later();
    self->sweep();
  });
}

/// Each room is asked on its own strand whether it may go.
void Atlas::Core::sweep() {
  in_turn([&](After& after) {
    if (stopping_) return;
    for (const auto& [name, page] : pages_) {
      if (page.state != Page::State::live) continue;
      const auto idle =
          page.visited ? idle_ : std::min<std::chrono::milliseconds>(idle_, kAskedMapIdle);
      after.push_back([this, room = page.room, idle_ms = idle.count()] {
        room->strand().post([self = shared_from_this(), room, idle_ms] {
          const bool unused = room->strand().now_ms() - room->last_used_ms() >= idle_ms;
          if (room->closed())
            self->let_go(*room, By::itself);
          else if (unused && room->retire([] {}))
            self->let_go(*room, By::sweep);
        });
      });
    }
  });
}

// A room that closed by itself may have many who hold it, and none of them needs its clerk; one
// that is put away parts with it when it has no more work for it.
void Atlas::Core::let_go(const Room& room, By whom) {
  in_turn([&](After& after) {
    Page* page = find(room.name());
    if (page == nullptr || page->room.get() != &room) return;
    after.push_back([map = page->take_room(), whom] {
      if (whom == By::itself) map.lease->end();
    });
  });
}

void Atlas::Core::count(const Failure& failure) {
  ++meters->journal_failures[static_cast<std::size_t>(failure.code)];
}

bool Atlas::Core::stop(std::chrono::milliseconds patience) {
  in_turn([&](After& after) {
    stopping_ = true;
    for (auto& [name, page] : pages_)
      if (page.state == Page::State::live) close(page, flush_and_close, ending().value(), after);
  });
  std::unique_lock lock(mutex_);
  const bool all = changed_.wait_for(lock, patience, [this] {
    return std::all_of(pages_.begin(), pages_.end(),
                       [](const auto& page) { return page.second.state == Page::State::closed; });
  });
  over_ = true;
  return all;
}

// Where `stop` ran out of patience, rooms wait for commits on strands that do not run any more, and
// hold one another's end up: whoever waits for one holds it. Their clerks must not outlive strands.
void Atlas::Core::part() {
  std::vector<RoomMaker::Furnished> left;
  {
    const std::lock_guard lock(mutex_);
    if (!over_) return;
    for (auto& [name, page] : pages_)
      if (page.state == Page::State::closing) left.push_back({page.parting.lock(), page.lease});
  }
  for (const auto& [room, lease] : left) {
    if (room) room->close({.failure = ending().value(), .retry_after_ms = {}});
    if (lease) lease->end();
  }
}

bool Atlas::Core::over() const {
  const std::lock_guard lock(mutex_);
  return over_;
}

Atlas::Atlas(AtlasOptions options) : core_(std::make_shared<Core>(std::move(options))) {
  core_->sweep_later();
}

Atlas::~Atlas() { core_->part(); }

protocol::Result<void> Atlas::take_stock() { return core_->take_stock(); }

void Atlas::create(const std::string& name, const protocol::MapSettings& settings, Opened done) {
  core_->create(name, settings, std::move(done));
}

void Atlas::open(const std::string& name, Errand errand, Opened done) {
  core_->open(name, errand, std::move(done));
}

void Atlas::erase(const std::string& name, Erased done) { core_->erase(name, std::move(done)); }

std::vector<Atlas::MapName> Atlas::list() const { return core_->list(); }

std::vector<std::shared_ptr<Room>> Atlas::rooms() const { return core_->rooms(); }

Meters& Atlas::meters() const { return *core_->meters; }

std::shared_ptr<Meters> Atlas::shared_meters() const { return core_->meters; }

void Atlas::let_go(const Room& closed) { core_->let_go(closed, Core::By::itself); }

bool Atlas::stop(std::chrono::milliseconds patience) { return core_->stop(patience); }

}  // namespace earthwork::room
