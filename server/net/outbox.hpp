/// What a session still has to write: control messages first, then one parcel of meshes, made
/// into messages only as the socket takes them.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "protocol/frame.hpp"
#include "protocol/messages.hpp"
#include "server/room/viewer.hpp"

namespace earthwork::net {

enum class Kind { text, binary };

struct OutgoingMessage {
  Kind kind = Kind::text;
  std::string bytes;
  bool ends_parcel = false;  ///< With it, the parcel is through.
};

/// A parcel as messages, one after the other. Holds one chunk record in messages at a time; the
/// others are shared with their room.
class ParcelMessages {
 public:
  explicit ParcelMessages(room::Parcel parcel);
  ParcelMessages(const ParcelMessages&) = delete;
  ParcelMessages& operator=(const ParcelMessages&) = delete;
  /// The last one has `ends_parcel`; none comes after it.
  [[nodiscard]] std::optional<OutgoingMessage> next();

 private:
  enum class Stage { begin, group, first_seen, caught_up, done };

  void advance();
  void add_records(std::vector<room::RecordBytes>& records, Stage after);

  room::Parcel parcel_;
  Stage stage_ = Stage::begin;
  std::size_t next_record_ = 0;
  std::deque<OutgoingMessage> made_;
  protocol::RecordPacker packer_;
};

/// One strand.
class Outbox {
 public:
  void say(const protocol::ServerMessage& message);
  /// Only when there is no parcel.
  void put(room::Parcel parcel);
  /// After what was said so far, this is the last message; parcels are dropped.
  void end(const protocol::Bye& bye);

  /// What to write next; nothing when there is nothing.
  [[nodiscard]] std::optional<OutgoingMessage> next();
  /// `end` was called, and its message was taken.
  [[nodiscard]] bool ended() const { return ending_ && control_.empty(); }
  [[nodiscard]] bool has_parcel() const { return parcel_.has_value(); }
  [[nodiscard]] std::size_t control_bytes() const { return control_bytes_; }

 private:
  std::deque<std::string> control_;  // bounded: nothing is read while it is long
  std::size_t control_bytes_ = 0;
  std::optional<ParcelMessages> parcel_;
  bool ending_ = false;
};

}  // namespace earthwork::net
