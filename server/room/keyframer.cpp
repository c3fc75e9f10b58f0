#include "server/room/keyframer.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cassert>
#include <deque>
#include <iterator>
#include <utility>

#include "server/room/caught.hpp"

namespace earthwork::room {
namespace {

using journal::Journal;
using protocol::Result;

/// A task of the clerk; to be repeated until it gives true.
using Step = std::function<Result<bool>(Journal& journal)>;

Step once(std::function<Result<void>(Journal& journal)> put) {
  return [put = std::move(put)](Journal& journal) { return put(journal).map([] { return true; }); };
}

/// `all` in portions of at most `size`, each to be held by several.
template <class T>
std::vector<std::shared_ptr<const std::vector<T>>> portions(std::vector<T> all, std::size_t size) {
  std::vector<std::shared_ptr<const std::vector<T>>> portions;
  for (auto from = all.begin(); from != all.end();) {
    const auto left = static_cast<std::size_t>(all.end() - from);
    const auto to = from + static_cast<std::ptrdiff_t>(std::min(size, left));
    portions.push_back(
        std::make_shared<const std::vector<T>>(std::move_iterator(from), std::move_iterator(to)));
    from = to;
  }
  return portions;
}

}  // namespace

struct Keyframer::Attempt {
  journal::Keyframe keyframe;
  ChunkSeqs changed;  // what it is made of, until it is put
  std::unordered_set<std::uint64_t> authors;
  std::deque<Step> steps;  // still to be done; the last one tidies
  bool durable = false;    // what it is as of
  bool with_clerk = false;

  [[nodiscard]] bool put() const { return steps.size() == 1; }
};

// The chunks whose age is above the newest keyframe's have changed since, by the events that were
// repeated; so it is with authors, whose last id is their latest.
Keyframer::Keyframer(Subject subject, const journal::Restored& start, KeyframePace pace)
    : subject_(std::move(subject)),
      pace_(pace),
      accepted_{start.seq, start.hash},
      handed_over_(accepted_),
      durable_(accepted_),
      newest_seq_(start.keyframe_seq),
      tried_seq_(newest_seq_) {
  for (const journal::ChunkAge& age : start.ages)
    if (age.seq > newest_seq_) changed_.emplace(age.key, age.seq);
  for (const journal::AuthorState& author : start.authors)
    if (!author.applied.empty() && author.applied.back().seq > newest_seq_)
      authors_.insert(author.author);
}

Keyframer::~Keyframer() = default;

void Keyframer::accepted(const history::Event& event, std::span<const voxel::ChunkKey> changed) {
  assert(event.seq == accepted_.seq + 1);
  accepted_ = {event.seq, event.hash};
  for (const voxel::ChunkKey& key : changed) changed_.insert_or_assign(key, event.seq);
  authors_.insert(event.author);
}

void Keyframer::handed_over() {
  handed_over_ = accepted_;
  if (!attempt_ && due()) begin();
}

// After one that failed, chunks alone do not make the next one due: they would at once.
bool Keyframer::due() const {
  if (handed_over_.seq - tried_seq_ >= pace_.events) return true;
  return tried_seq_ == newest_seq_ && changed_.size() >= pace_.chunks;
}

void Keyframer::durable() {
  durable_ = handed_over_;
  if (!attempt_ || attempt_->durable) return;
  attempt_->durable = true;
  go_on();
}

// A start refuses chunks of a layer that its keyframe does not have.
void Keyframer::taken_back() {
  accepted_ = handed_over_ = durable_;
  if (attempt_ && !attempt_->durable) drop();
  const int layers = subject_.map.grid().layers;
  std::erase_if(changed_, [&](const auto& chunk) { return chunk.first.layer >= layers; });
}

// The map is what it is as of `handed_over_`. A chunk that was changed last by an event that was
// taken back since has been as it is for longer than is told.
void Keyframer::begin() {
  attempt_ = std::make_unique<Attempt>();
  attempt_->keyframe = {handed_over_.seq, handed_over_.hash, subject_.clock.now_ms(),
                        subject_.settings};
  attempt_->changed = std::exchange(changed_, {});
  attempt_->authors = std::exchange(authors_, {});

  std::vector<journal::ChunkState> chunks;
  chunks.reserve(attempt_->changed.size());
  for (const auto& [key, seq] : attempt_->changed) {
    const voxel::Chunk* chunk = subject_.map.find(key);
    chunks.push_back({.key = key,
                      .seq = std::min(seq, handed_over_.seq),
                      .chunk = chunk ? *chunk : voxel::Chunk(subject_.map.grid().resolution)});
  }
  for (auto& portion : portions(std::move(chunks), kChunksPerTask))
    attempt_->steps.push_back(
        once([portion](Journal& journal) { return journal.put_chunks(*portion); }));

  std::vector<journal::AuthorState> authors;
  for (const std::uint64_t author : attempt_->authors)
    if (auto state = subject_.author(author); !state.applied.empty())
      authors.push_back(std::move(state));
  for (auto& portion : portions(std::move(authors), kAuthorsPerTask))
    attempt_->steps.push_back(
        once([portion](Journal& journal) { return journal.put_authors(*portion); }));

  attempt_->steps.push_back(once([keyframe = attempt_->keyframe](Journal& journal) {
    return journal.put_keyframe(keyframe);
  }));
  attempt_->steps.push_back([](Journal& journal) { return journal.tidy(kRowsTidiedPerTask); });
}

// One task at a time, so that whatever else waits for the clerk comes in between. A clerk that
// works within `post` is not posted to from there, but here in turn.
void Keyframer::go_on() {
  if (posting_) return;
  posting_ = true;
  while (attempt_ && attempt_->durable && !attempt_->with_clerk) {
    attempt_->with_clerk = true;
    subject_.clerk.post(
        journal::Urgency::idle,
        [this, step = attempt_->steps.front(), back = subject_.workplace().back](Journal& journal) {
          back([this, outcome = caught([&] { return step(journal); })] { came(outcome); });
        });
  }
  posting_ = false;
}

void Keyframer::came(const Result<bool>& outcome) {
  attempt_->with_clerk = false;
  if (!outcome) {
    spdlog::warn("keyframe {}: {}", attempt_->keyframe.seq, outcome.error().detail);
    ++subject_.meters->journal_failures[static_cast<std::size_t>(outcome.error().code)];
    tried_seq_ = attempt_->keyframe.seq;
    drop();
  } else if (*outcome) {
    attempt_->steps.pop_front();
    if (attempt_->put()) note_put();
    if (attempt_->steps.empty()) attempt_.reset();
  }
  if (!attempt_ && finished_) wind_up();
  go_on();
}

void Keyframer::note_put() {
  ++subject_.meters->keyframes;
  newest_seq_ = tried_seq_ = attempt_->keyframe.seq;
  attempt_->changed.clear();
  attempt_->authors.clear();
}

// What it was made of counts as changed again; what has changed since keeps its later seq.
void Keyframer::drop() {
  changed_.merge(attempt_->changed);
  authors_.merge(attempt_->authors);
  attempt_.reset();
}

void Keyframer::finish(std::function<void()> done) {
  finished_ = std::move(done);
  if (!attempt_) wind_up();
}

void Keyframer::wind_up() {
  const bool settled = accepted_.seq == durable_.seq;
  if (!last_ && settled && accepted_.seq > newest_seq_) {
    last_ = true;
    begin();
    attempt_->durable = true;
    return go_on();
  }
  last_ = false;
  std::exchange(finished_, nullptr)();
}

}  // namespace earthwork::room
