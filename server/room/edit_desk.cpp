#include "server/room/edit_desk.hpp"

#include <string>
#include <utility>

#include "server/history/fold.hpp"

namespace earthwork::room {
namespace {

using protocol::Code;

// A turn applies edits until one of these bounds, then shows them: so that a crowd of editors is
// meshed and sent for once, and that a flood of edits does not keep everybody waiting. Rows count
// whether or not they change. An edit of very many is not applied in a turn but prepared between
// turns.
constexpr int kTurnEdits = 512;
constexpr std::size_t kTurnDirtyChunks = 1024;
constexpr std::uint64_t kTurnRows = 262'144;

/// To an edit whose id is neither fresh nor known.
protocol::Rejected refusal(protocol::MessageId id, Authors::Standing standing) {
  const bool too_old = standing == Authors::Standing::too_old;
  const std::string why = too_old ? " is below the last " +
                                        std::to_string(protocol::kMaxRememberedIds) +
                                        ", which are all that are remembered"
                                  : " was not applied, and a larger one was";
  return {.id = id,
          .failure = {too_old ? Code::id_too_old : Code::id_out_of_order,
                      "id: " + std::to_string(id) + why, "id"}};
}

}  // namespace

EditDesk::EditDesk(Subject subject, Commits commits, std::span<const journal::AuthorState> authors,
                   std::uint64_t seq, std::shared_ptr<Meters> meters, Told told)
    : map_(subject.map),
      settings_(subject.settings),
      commits_(commits),
      meters_(std::move(meters)),
      told_(std::move(told)),
      authors_(authors),
      slicer_(subject.map),
      last_seq_(seq),
      durable_seq_(seq) {}

void EditDesk::take_turn() {
  turn_chunks_ = 0, turn_rows_ = 0;
  if (slicer_.through()) apply_prepared();
  for (int n = 0; n < kTurnEdits && turn_chunks_ < kTurnDirtyChunks && turn_rows_ < kTurnRows &&
                  line_.has_next() && !told_.full();
       ++n)
    take_next();
}

// What cannot be applied now keeps its place in line, and its author's later ones wait behind it.
// So whatever was fresh when its preparation began is fresh at its end.
void EditDesk::take_next() {
  const Line::Waiting& next = line_.next();
  if (slicer_.must_wait(next)) return line_.put_aside();
  if (Slicer::too_large(next) && may_begin(next.command)) {
    slicer_.start(next.command);
    return line_.put_aside();
  }
  Line::Waiting taken = line_.pop();
  turn_rows_ += taken.cost;
  decide(taken);
}

bool EditDesk::may_begin(const Command& command) const {
  return authors_.judge(command.author, command.id).standing == Authors::Standing::fresh &&
         protocol::check_layers(command.action, settings_.accepted()).has_value();
}

// A refusal may rest on what is not durable yet: on a larger id of its author, or on a layer.
void EditDesk::decide(Line::Waiting& edit) {
  const Command& command = edit.command;
  const auto [standing, seq] = authors_.judge(command.author, command.id);
  if (standing == Authors::Standing::fresh) return carry_out(edit);
  if (standing == Authors::Standing::repeated) {
    ++meters_->repeated;
    return told_.answered(edit.viewer, protocol::Applied{.id = command.id, .seq = seq}, seq);
  }
  told_.answered(edit.viewer, refusal(command.id, standing), last_seq_);
}

void EditDesk::carry_out(Line::Waiting& edit) {
  const Command& command = edit.command;
  if (auto checked = protocol::check_layers(command.action, settings_.accepted()); !checked)
    return told_.answered(edit.viewer, protocol::Rejected{command.id, std::move(checked.error())},
                          last_seq_);
  if (const auto* change = std::get_if<protocol::LayerChange>(&command.action)) {
    settings_.accept(*change);
  } else if (commits_ == Commits::later) {
    const auto& stamped = std::get<protocol::Edit>(command.action);
    before_.keep(map_, static_cast<int>(stamped.layer), history::stencils(stamped));
  }
  applied(edit, history::apply(map_, command.action));
}

void EditDesk::apply_prepared() {
  Line::Waiting edit = line_.take(slicer_.author());
  line_.recall();
  if (commits_ == Commits::later) before_.keep(map_, slicer_.changed());
  applied(edit, slicer_.commit());
}

void EditDesk::applied(Line::Waiting& edit, const voxel::Change& change) {
  turn_chunks_ += change.dirty.size();
  const auto [id, author] = std::pair(edit.command.id, edit.command.author);
  last_seq_ = told_.applied(edit.command, change);
  authors_.applied(author, id, last_seq_);
  told_.answered(edit.viewer, protocol::Applied{.id = id, .seq = last_seq_}, last_seq_);
}

void EditDesk::handed_over() { before_.hand_over(); }

void EditDesk::durable(std::uint64_t seq) {
  durable_seq_ = seq;
  authors_.keep(seq);
  before_.forget_handed_over();
}

// Whoever waits for a number, waits for one above those that are gone: it has none either.
void EditDesk::take_back(const protocol::Failure& why) {
  before_.take_back(map_);
  settings_.take_back();
  map_.set_layers(static_cast<int>(settings_.accepted().layers.size()));
  authors_.take_back();
  last_seq_ = durable_seq_;
  slicer_.clear();
  line_.recall();
  while (line_.has_next()) {
    const Line::Waiting refused = line_.pop();
    told_.answered(refused.viewer, protocol::Rejected{refused.command.id, why}, durable_seq_);
  }
}

void EditDesk::clear() {
  line_.clear();
  slicer_.clear();
}

}  // namespace earthwork::room
