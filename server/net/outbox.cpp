#include "server/net/outbox.hpp"

#include <cassert>
#include <utility>

namespace earthwork::net {

ParcelMessages::ParcelMessages(room::Parcel parcel)
    : parcel_(std::move(parcel)), packer_([this](std::string message) {
        made_.push_back({.kind = Kind::binary, .bytes = std::move(message)});
      }) {}

std::optional<OutgoingMessage> ParcelMessages::next() {
  // One message ahead, to know which one is the last.
  while (made_.size() < 2 && stage_ != Stage::done) advance();
  if (made_.empty()) return std::nullopt;
  OutgoingMessage message = std::move(made_.front());
  made_.pop_front();
  message.ends_parcel = made_.empty() && stage_ == Stage::done;
  return message;
}

void ParcelMessages::advance() {
  switch (stage_) {
    case Stage::begin:
      if (parcel_.group)
        made_.push_back({.kind = Kind::binary, .bytes = protocol::encode(*parcel_.group)});
      stage_ = Stage::group;
      return;
    case Stage::group:
      add_records(parcel_.group_records, Stage::first_seen);
      if (stage_ == Stage::first_seen && parcel_.group)
        made_.push_back({.kind = Kind::binary,
                         .bytes = protocol::encode(protocol::GroupEnd{parcel_.group->seq})});
      return;
    case Stage::first_seen:
      add_records(parcel_.first_seen, Stage::caught_up);
      return;
    case Stage::caught_up:
      if (parcel_.caught_up)
        made_.push_back({.kind = Kind::text, .bytes = protocol::write(*parcel_.caught_up)});
      stage_ = Stage::done;
      return;
    case Stage::done:
      return;
  }
}

void ParcelMessages::add_records(std::vector<room::RecordBytes>& records, Stage after) {
  if (next_record_ < records.size()) {
    const room::RecordBytes record = std::exchange(records[next_record_++], nullptr);
    packer_.add(*record);
    return;
  }
  packer_.finish();
  next_record_ = 0;
  stage_ = after;
}

void Outbox::say(const protocol::ServerMessage& message) {
  if (ending_) return;
  control_.push_back(protocol::write(message));
  control_bytes_ += control_.back().size();
}

void Outbox::put(room::Parcel parcel) {
  if (ending_) return;
  assert(!parcel_);
  parcel_.emplace(std::move(parcel));
}

void Outbox::end(const protocol::Bye& bye) {
  say(bye);
  ending_ = true;
  parcel_.reset();
}

std::optional<OutgoingMessage> Outbox::next() {
  if (!control_.empty()) {
    OutgoingMessage message{.kind = Kind::text, .bytes = std::move(control_.front())};
    control_.pop_front();
    control_bytes_ -= message.bytes.size();
    return message;
  }
  if (!parcel_) return std::nullopt;
  auto message = parcel_->next();
  if (!message || message->ends_parcel) parcel_.reset();
  return message;
}

}  // namespace earthwork::net
