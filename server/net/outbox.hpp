/// What a session still has to write: control messages first, then the map's settings, then what is
/// told of people and events, then one parcel of meshes, made into messages only as the socket
/// takes them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "protocol/messages.hpp"
#include "server/net/outbox_counts.hpp"
#include "server/net/parcel_messages.hpp"
#include "server/room/viewer.hpp"

namespace earthwork::net {

/// One strand.
class Outbox {
 public:
  void say(const protocol::ServerMessage& message);
  /// A message that stands for the one before, if that was not taken yet.
  void put_settings(room::SharedText message);
  /// They are of a map that was left.
  void forget_settings() { settings_.reset(); }
  /// Only when there is no parcel.
  void put(room::Parcel parcel);
  /// Only when there is no talk.
  void put(room::Talk talk);
  /// After what was said so far, this is the last message; parcels and talk are dropped.
  void end(const protocol::Bye& bye);

  /// Appends whole messages, as they go over the socket, until `out` has `enough` bytes or nothing
  /// waits. The last message may be a long one.
  void take(std::string& out, std::size_t enough, OutboxCounts& counts);
  /// All that was taken is written: whoever waits for it may be told.
  struct Through {
    bool parcel = false, talk = false;
  };
  [[nodiscard]] Through written();

  /// `end` was called, and its message was taken.
  [[nodiscard]] bool ended() const { return ending_ && control_.empty(); }
  /// A parcel, or talk, is not written yet.
  [[nodiscard]] bool has_parcel() const { return parcel_.has_value() || parcel_taken_; }
  [[nodiscard]] bool has_talk() const { return !talk_.messages.empty() || talk_taken_; }
  /// That wait to be taken.
  [[nodiscard]] std::size_t control_bytes() const { return control_.size(); }

 private:
  [[nodiscard]] bool take_next(std::string& out, OutboxCounts& counts);
  void take_control(std::string& out, OutboxCounts& counts);

  std::string control_;  // as it goes over the socket; bounded: nothing is read while it is long
  OutboxCounts control_counts_;
  room::SharedText settings_;
  room::Talk talk_;
  std::size_t next_talk_ = 0;
  bool meshes_next_ = false;  // a talk is through: whoever reads slowly must not hear only talks
  std::optional<ParcelMessages> parcel_;
  bool parcel_taken_ = false, talk_taken_ = false;  // and not written yet
  bool ending_ = false;
};

}  // namespace earthwork::net
