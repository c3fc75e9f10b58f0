#include "server/net/outbox.hpp"

#include <cassert>
#include <utility>

namespace earthwork::net {
namespace {

// More than that is given back when it is empty: most sessions say little, and rarely.
constexpr std::size_t kKeptBytes = 512;

}  // namespace

void Outbox::say(const protocol::ServerMessage& message) {
  if (ending_) return;
  append_counted(control_, control_counts_, Kind::text, protocol::write(message));
}

void Outbox::put_settings(room::SharedText message) {
  if (!ending_) settings_ = std::move(message);
}

void Outbox::put(room::Parcel parcel) {
  if (ending_) return;
  assert(!has_parcel());
  parcel_.emplace(std::move(parcel));
}

void Outbox::put(room::Talk talk) {
  if (ending_) return;
  assert(!has_talk());
  talk_ = std::move(talk);
  next_talk_ = 0;
  talk_taken_ = talk_.messages.empty();
}

void Outbox::end(const protocol::Bye& bye) {
  if (ending_) return;
  say(bye);
  ending_ = true;
  parcel_.reset();
  settings_.reset();
  talk_ = {};
}

void Outbox::take(std::string& out, std::size_t enough, OutboxCounts& counts) {
  while (out.size() < enough && take_next(out, counts)) {
  }
}

bool Outbox::take_next(std::string& out, OutboxCounts& counts) {
  if (!control_.empty()) {
    take_control(out, counts);
  } else if (settings_) {
    append_counted(out, counts, Kind::text, *std::exchange(settings_, nullptr));
  } else if (!talk_.messages.empty() && !(meshes_next_ && parcel_)) {
    append_counted(out, counts, Kind::text, *talk_.messages[next_talk_++]);
    if (next_talk_ < talk_.messages.size()) return true;
    talk_ = {};
    talk_taken_ = true;
    meshes_next_ = true;
  } else if (parcel_) {
    meshes_next_ = false;
    if (!parcel_->through()) parcel_->append_next(out, counts);
    if (!parcel_->through()) return true;
    parcel_.reset();
    parcel_taken_ = true;
  } else {
    return false;
  }
  return true;
}

void Outbox::take_control(std::string& out, OutboxCounts& counts) {
  out += control_;
  counts.add(std::exchange(control_counts_, {}));
  control_.clear();
  if (control_.capacity() > kKeptBytes) control_.shrink_to_fit();
}

Outbox::Through Outbox::written() {
  return {.parcel = std::exchange(parcel_taken_, false), .talk = std::exchange(talk_taken_, false)};
}

}  // namespace earthwork::net
