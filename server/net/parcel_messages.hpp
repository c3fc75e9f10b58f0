/// A parcel as messages of a WebSocket, written one after the other straight from the records that
/// the room shares.
#pragma once

#include <cstddef>
#include <string>

#include "server/net/outbox_counts.hpp"
#include "server/room/viewer.hpp"

namespace earthwork::net {

class ParcelMessages {
 public:
  explicit ParcelMessages(room::Parcel parcel);

  /// All was appended.
  [[nodiscard]] bool through() const { return stage_ == Stage::through; }
  /// Appends the next message; not once it is through.
  void append_next(std::string& out, OutboxCounts& counts);

 private:
  enum class Stage { begin, group, end, first_seen, caught_up, through };

  [[nodiscard]] bool anything_to_say() const;
  [[nodiscard]] std::vector<room::RecordBytes>& records();
  void go_on();
  void append_records(std::string& out, OutboxCounts& counts);

  room::Parcel parcel_;
  Stage stage_ = Stage::begin;
  // Where the next message of records starts.
  std::size_t record_ = 0, offset_ = 0;
};

}  // namespace earthwork::net
