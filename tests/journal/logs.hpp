/// Logs to test with: events as a room would have accepted them, and journals that hold them.
#pragma once

#include <rapidcheck/gtest.h>

#include <memory>
#include <vector>

#include "server/history/fold.hpp"
#include "server/journal/execution.hpp"
#include "server/journal/memory_journal.hpp"
#include "server/journal/whole_keyframe.hpp"

namespace earthwork::journal {

inline Identity small_identity() {
  Identity identity{.settings = {}, .epoch = 0xfedcba9876543210, .created_ms = 1700000000000};
  identity.settings.chunk_resolution = 8;
  return identity;
}

/// Numbers them from 1 on, gives them to three authors in turn, and fills in the hashes.
inline std::vector<history::Event> accepted(const std::vector<protocol::Action>& actions) {
  voxel::Map map = history::make_map(small_identity().settings);
  std::vector<history::Event> events;
  for (const protocol::Action& action : actions) {
    const std::uint64_t seq = events.size() + 1;
    history::apply(map, action);
    events.push_back({.seq = seq,
                      .time_ms = static_cast<std::int64_t>(1700000000000 + 10 * seq),
                      .author = 0xa0 + seq % 3,
                      .id = static_cast<std::int64_t>(100 + seq),
                      .action = action,
                      .hash = map.hash()});
  }
  return events;
}

inline protocol::Edit disc(double x, double y, double radius, bool fill = true) {
  return {.fill = fill, .radius = radius, .path = {{x, y}}, .stroke = {}};
}

/// A disc of one of three layers, which may not be there, or a change of layers.
inline rc::Gen<protocol::Action> any_action() {
  return rc::gen::exec([]() -> protocol::Action {
    const auto layer = *rc::gen::inRange(0u, 3u);
    const int lot = *rc::gen::inRange(0, 12);
    if (lot == 0) return protocol::LayerChange{.layer = {}, .name = {}, .color = {}, .wall = {}};
    if (lot == 1)
      return protocol::LayerChange{.layer = layer, .name = "a", .color = {}, .wall = {{-1, 2}}};
    const auto place = rc::gen::inRange(-60, 60);
    protocol::Edit edit = disc(*place / 2.0, *place / 2.0, *rc::gen::inRange(0, 24) / 2.0,
                               *rc::gen::weightedElement<bool>({{3, true}, {2, false}}));
    edit.layer = lot < 4 ? layer : 0;
    return edit;
  });
}

/// What a map accepts of such: discs that fill and empty, close enough together that chunks come
/// and go, and changes of layers.
inline rc::Gen<std::vector<protocol::Action>> some_actions() {
  return rc::gen::map(rc::gen::container<std::vector<protocol::Action>>(any_action()),
                      [](std::vector<protocol::Action> actions) {
                        protocol::MapSettings settings = small_identity().settings;
                        std::erase_if(actions, [&settings](const protocol::Action& action) {
                          if (!protocol::check_layers(action, settings)) return true;
                          protocol::apply(action, settings);
                          return false;
                        });
                        return actions;
                      });
}

/// Appends `events`, with a keyframe after each of `keyframes` as of the seq it names.
inline void fill(Journal& journal, const std::vector<history::Event>& events,
                 const std::vector<std::uint64_t>& keyframes) {
  Execution executed(journal.identity().settings);
  for (const history::Event& event : events) {
    RC_ASSERT(executed.apply(event).has_value());
    RC_ASSERT(journal.append(event.seq - 1, {&event, 1}).has_value());
    for (const std::uint64_t seq : keyframes)
      if (seq == event.seq)
        RC_ASSERT(put_whole_keyframe(journal, executed, event.time_ms).has_value());
  }
}

inline std::unique_ptr<Journal> journal_of(const std::vector<history::Event>& events,
                                           const std::vector<std::uint64_t>& keyframes = {}) {
  auto journal = make_memory_journal(small_identity());
  fill(*journal, events, keyframes);
  return journal;
}

/// Nine discs in a row, each as large as a chunk; the fourth one is taken away again.
inline std::vector<history::Event> ten_events() {
  std::vector<protocol::Action> edits;
  for (int i = 0; i < 9; ++i) edits.push_back(disc(10.0 * i, 4, 3));
  edits.push_back(disc(30, 4, 5, false));
  return accepted(edits);
}

}  // namespace earthwork::journal
