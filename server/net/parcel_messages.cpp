#include "server/net/parcel_messages.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "protocol/frame.hpp"
#include "protocol/limits.hpp"

namespace earthwork::net {

ParcelMessages::ParcelMessages(room::Parcel parcel) : parcel_(std::move(parcel)) {
  while (!anything_to_say()) go_on();
}

bool ParcelMessages::anything_to_say() const {
  switch (stage_) {
    case Stage::begin:
    case Stage::end:
      return parcel_.group.has_value();
    case Stage::group:
      return record_ < parcel_.group_records.size();
    case Stage::first_seen:
      return record_ < parcel_.first_seen.size();
    case Stage::caught_up:
      return parcel_.caught_up.has_value();
    case Stage::through:
      break;
  }
  return true;
}

std::vector<room::RecordBytes>& ParcelMessages::records() {
  return stage_ == Stage::group ? parcel_.group_records : parcel_.first_seen;
}

void ParcelMessages::go_on() {
  stage_ = static_cast<Stage>(static_cast<int>(stage_) + 1);
  record_ = 0;
}

void ParcelMessages::append_next(std::string& out, OutboxCounts& counts) {
  assert(!through());
  switch (stage_) {
    case Stage::begin:
      append_counted(out, counts, Kind::binary, protocol::encode(*parcel_.group));
      go_on();
      break;
    case Stage::end:
      append_counted(out, counts, Kind::binary,
                     protocol::encode(protocol::GroupEnd{parcel_.group->seq}));
      go_on();
      break;
    case Stage::caught_up:
      append_counted(out, counts, Kind::text, protocol::write(*parcel_.caught_up));
      go_on();
      break;
    case Stage::group:
    case Stage::first_seen:
      append_records(out, counts);
      break;
    case Stage::through:
      break;
  }
  while (!anything_to_say()) go_on();
}

void ParcelMessages::append_records(std::string& out, OutboxCounts& counts) {
  const std::string_view head = protocol::records_head();
  std::vector<room::RecordBytes>& records = this->records();

  std::size_t bytes = head.size();
  for (std::size_t i = record_, from = offset_; i < records.size(); ++i, from = 0) {
    bytes += records[i]->size() - from;
    if (bytes >= protocol::kMaxFrameBytes) break;
  }
  bytes = std::min(bytes, protocol::kMaxFrameBytes);

  append_head(out, Kind::binary, bytes);
  counts.add(Kind::binary, bytes);
  out += head;
  for (bytes -= head.size(); bytes > 0;) {
    const std::string& record = *records[record_];
    const std::size_t piece = std::min(record.size() - offset_, bytes);
    out.append(record, offset_, piece);
    bytes -= piece;
    offset_ += piece;
    if (offset_ < record.size()) break;
    records[record_++].reset();  // a newer version may have taken its place in the room
    offset_ = 0;
  }
}

}  // namespace earthwork::net
