/// A viewer for tests: keeps what it is told, and the mesh that its parcels add up to.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "protocol/chunk_record.hpp"
#include "server/room/room.hpp"
#include "server/room/viewer.hpp"

namespace earthwork::room {

class Onlooker final : public Viewer {
 public:
  void answered(std::vector<Reply> replies) override;
  void tell(Talk talk) override;
  void settings(SharedText message) override;
  /// Expects no chunk of a layer that it was not told of.
  void deliver(Parcel parcel) override;
  void end(protocol::Bye why) override { bye = std::move(why); }

  /// What the mesh hash of a whole map would be that had these chunks.
  [[nodiscard]] std::uint64_t mesh_hash() const;
  /// Of all parcels: the records of groups, and those outside.
  [[nodiscard]] std::size_t grouped() const;
  [[nodiscard]] std::size_t first_seen() const;
  void forget_parcels() { parcels.clear(); }
  /// Of all talks, in order.
  [[nodiscard]] std::vector<protocol::Presence> people() const;
  [[nodiscard]] std::vector<protocol::Event> events() const;
  [[nodiscard]] std::vector<protocol::ChatLine> chat() const;

  std::vector<protocol::Applied> acks;
  std::vector<protocol::Rejected> refusals;
  std::vector<Talk> talks;
  std::vector<Parcel> parcels;
  std::vector<protocol::SettingsChanged> settings_told;
  std::size_t known_layers = protocol::kMaxLayers;  ///< Fewer once somebody says so.
  std::optional<protocol::Bye> bye;
  std::map<protocol::ChunkKey, protocol::ChunkRecord> chunks;

 private:
  [[nodiscard]] protocol::ChunkRecord after(const RecordBytes& bytes) const;
};

/// Of a full record.
[[nodiscard]] protocol::ChunkRecord decoded(const RecordBytes& bytes);
/// Of a delta too.
[[nodiscard]] protocol::ChunkKey key_of(const RecordBytes& bytes);
[[nodiscard]] bool is_delta(const RecordBytes& bytes);

/// The first pair of neighbours whose vertices on their common rim line differ, as text; empty
/// when all agree.
[[nodiscard]] std::string torn_rim(
    const std::map<protocol::ChunkKey, protocol::ChunkRecord>& chunks, int resolution);

/// Edits, changes of layers and views, shortly.
[[nodiscard]] protocol::Edit disc(double x, double y, double radius, bool fill = true);
[[nodiscard]] protocol::Edit box(double x, double y, double radius, bool fill = true);
[[nodiscard]] protocol::LayerChange add_layer(const std::string& name);
[[nodiscard]] protocol::LayerChange rename_layer(std::uint32_t layer, const std::string& name);
[[nodiscard]] protocol::Edit on_layer(std::uint32_t layer, protocol::Edit edit);
[[nodiscard]] protocol::View view_all(std::uint32_t n);
[[nodiscard]] protocol::View view_rect(std::uint32_t n, protocol::MapRect rect);

}  // namespace earthwork::room
