/// Where edits, and changes of layers, that are asked for become events: they come to their turn in
/// a fair order, those that are new are applied, those that are not are known again, and what is
/// too large to be applied at once is prepared aside.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "protocol/messages.hpp"
#include "protocol/result.hpp"
#include "server/journal/journal.hpp"
#include "server/room/authors.hpp"
#include "server/room/before_images.hpp"
#include "server/room/line.hpp"
#include "server/room/meters.hpp"
#include "server/room/opening.hpp"
#include "server/room/settings_book.hpp"
#include "server/room/slicer.hpp"
#include "server/room/viewer.hpp"
#include "server/voxel/change.hpp"
#include "server/voxel/map.hpp"

namespace earthwork::room {

/// On the strand of the room whose part it is.
class EditDesk {
 public:
  /// What it tells; none of these may call it back.
  struct Told {
    /// The map has the edit now, and nothing after it. Gives back its seq, and may take the
    /// command.
    std::function<std::uint64_t(Command&, const voxel::Change&)> applied;
    /// What became of an edit of this viewer: true once event `seq` is durable.
    std::function<void(ViewerId, Reply, std::uint64_t seq)> answered;
    /// No more edits can be taken now.
    std::function<bool()> full;
  };
  /// The map and its settings outlive it, and nobody else changes what is accepted of them.
  struct Subject {
    voxel::Map& map;
    SettingsBook& settings;
  };
  /// `authors` is what is remembered of them up to event `seq`, the map's last. Counts in `meters`
  /// what is repeated.
  EditDesk(Subject subject, Commits commits, std::span<const journal::AuthorState> authors,
           std::uint64_t seq, std::shared_ptr<Meters> meters, Told told);

  /// Puts an edit in line that is valid if the map has its layer, or a change of layers, as
  /// Line::push does. Whether the layer is there shows in its turn: one before it may add it.
  [[nodiscard]] bool push(Line::Waiting edit) { return line_.push(std::move(edit)); }
  /// Takes edits until none is next, or for as long as a turn may be.
  void take_turn();
  /// There is somebody for another turn.
  [[nodiscard]] bool has_next() const { return line_.has_next(); }
  /// An edit is in preparation: `prepare` is to be called until this is false, then `take_turn`.
  [[nodiscard]] bool preparing() const { return slicer_.busy() && !slicer_.through(); }
  void prepare() { slicer_.advance(); }

  /// What was applied is on its way into the journal, and nothing else is.
  void handed_over();
  /// It is durable, up to `seq`.
  void durable(std::uint64_t seq);
  /// The map and its settings become what they were after the last durable event; whoever is in
  /// line is refused, for this.
  void take_back(const protocol::Failure& why);
  /// Nobody is in line any more, and nobody is told.
  void clear();

  /// Those in line, with the one in preparation.
  [[nodiscard]] const Line& line() const { return line_; }
  [[nodiscard]] const Authors& authors() const { return authors_; }

 private:
  void take_next();
  [[nodiscard]] bool may_begin(const Command& command) const;
  void decide(Line::Waiting& edit);
  void carry_out(Line::Waiting& edit);
  void apply_prepared();
  void applied(Line::Waiting& edit, const voxel::Change& change);

  voxel::Map& map_;
  SettingsBook& settings_;
  const Commits commits_;
  const std::shared_ptr<Meters> meters_;
  const Told told_;
  BeforeImages before_;  // of what is not durable, unless commits are at once
  Authors authors_;
  Line line_;
  Slicer slicer_;                // what it prepares is aside in the line
  std::uint64_t last_seq_;       // of the map
  std::uint64_t durable_seq_;    // up to which nothing is taken back
  std::size_t turn_chunks_ = 0;  // to be meshed again, of this turn, a chunk once an edit
  std::uint64_t turn_rows_ = 0;  // that this turn looked at, a row once a stamp
};

}  // namespace earthwork::room
