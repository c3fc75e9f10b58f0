#include "tests/room/onlooker.hpp"

#include <gtest/gtest.h>

#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "protocol/record_delta.hpp"

namespace earthwork::room {
namespace {

using protocol::ChunkKey;
using protocol::ChunkRecord;
using Rim = std::set<std::int32_t>;

constexpr std::int32_t kHalf = 16384, kVoxel = 32768;

/// Where the mesh has vertices on the line x = `at`, or y = `at` when `along_x`.
Rim rim_of(const std::map<ChunkKey, ChunkRecord>& chunks, const ChunkKey& key, std::int32_t at,
           bool along_x) {
  Rim rim;
  const auto found = chunks.find(key);
  if (found == chunks.end()) return rim;
  for (const auto& p : found->second.mesh.vertices) {
    const auto [across, along] = along_x ? std::pair(p.y, p.x) : std::pair(p.x, p.y);
    if (across == at) rim.insert(along);
  }
  return rim;
}

/// The messages of this type.
template <class Message>
std::vector<Message> heard(const std::vector<Talk>& talks) {
  std::vector<Message> messages;
  for (const Talk& talk : talks)
    for (const SharedText& text : talk.messages) {
      const auto message = protocol::parse_server_message(*text).value();
      if (const auto* one = std::get_if<Message>(&message)) messages.push_back(*one);
    }
  return messages;
}

std::string text(const ChunkKey& key) {
  return "chunk " + std::to_string(key.x) + ", " + std::to_string(key.y);
}

}  // namespace

ChunkRecord decoded(const RecordBytes& bytes) {
  return protocol::decode_record(std::as_bytes(std::span(*bytes))).value();
}

bool is_delta(const RecordBytes& bytes) {
  return protocol::is_delta(std::as_bytes(std::span(*bytes)));
}

ChunkKey key_of(const RecordBytes& bytes) {
  if (!is_delta(bytes)) return decoded(bytes).key;
  return protocol::decode_delta(std::as_bytes(std::span(*bytes))).value().key;
}

ChunkRecord Onlooker::after(const RecordBytes& bytes) const {
  if (!is_delta(bytes)) return decoded(bytes);
  const auto delta = protocol::decode_delta(std::as_bytes(std::span(*bytes))).value();
  const ChunkRecord& base = chunks.at(delta.key);
  if (base.revision != delta.base_revision) throw std::runtime_error("a delta of another base");
  return protocol::apply_delta(base.mesh, delta).value();
}

void Onlooker::answered(std::vector<Reply> replies) {
  for (const Reply& reply : replies) {
    if (const auto* applied = std::get_if<protocol::Applied>(&reply)) acks.push_back(*applied);
    if (const auto* rejected = std::get_if<protocol::Rejected>(&reply))
      refusals.push_back(*rejected);
  }
}

void Onlooker::tell(Talk talk) { talks.push_back(std::move(talk)); }

void Onlooker::settings(SharedText message) {
  settings_told.push_back(
      std::get<protocol::SettingsChanged>(protocol::parse_server_message(*message).value()));
  known_layers = settings_told.back().settings.layers.size();
}

void Onlooker::deliver(Parcel parcel) {
  for (const auto* records : {&parcel.group_records, &parcel.first_seen}) {
    for (const RecordBytes& bytes : *records) {
      ChunkRecord record = after(bytes);
      EXPECT_LT(record.key.layer, static_cast<std::int32_t>(known_layers));
      if (record.removed)
        chunks.erase(record.key);
      else
        chunks[record.key] = std::move(record);
    }
  }
  parcels.push_back(std::move(parcel));
}

std::vector<protocol::Presence> Onlooker::people() const {
  return heard<protocol::Presence>(talks);
}

std::vector<protocol::Event> Onlooker::events() const { return heard<protocol::Event>(talks); }

std::vector<protocol::ChatLine> Onlooker::chat() const {
  std::vector<protocol::ChatLine> lines;
  for (const auto& chat : heard<protocol::ChatLines>(talks))
    lines.insert(lines.end(), chat.lines.begin(), chat.lines.end());
  return lines;
}

std::uint64_t Onlooker::mesh_hash() const {
  std::uint64_t sum = 0;
  for (const auto& [key, record] : chunks)
    sum += protocol::mesh_hash_term(key, protocol::mesh_hash(record.mesh));
  return sum;
}

std::size_t Onlooker::grouped() const {
  std::size_t count = 0;
  for (const Parcel& parcel : parcels) count += parcel.group_records.size();
  return count;
}

std::size_t Onlooker::first_seen() const {
  std::size_t count = 0;
  for (const Parcel& parcel : parcels) count += parcel.first_seen.size();
  return count;
}

std::string torn_rim(const std::map<ChunkKey, ChunkRecord>& chunks, int resolution) {
  const std::int32_t far = resolution * kVoxel + kHalf;
  for (const auto& [key, record] : chunks) {
    ChunkKey right = key, upper = key, left = key, lower = key;
    ++right.x, ++upper.y, --left.x, --lower.y;
    if (rim_of(chunks, key, far, false) != rim_of(chunks, right, kHalf, false))
      return text(key) + " and the one to its right";
    if (rim_of(chunks, key, far, true) != rim_of(chunks, upper, kHalf, true))
      return text(key) + " and the one above";
    if (rim_of(chunks, key, kHalf, false) != rim_of(chunks, left, far, false))
      return text(key) + " and the one to its left";
    if (rim_of(chunks, key, kHalf, true) != rim_of(chunks, lower, far, true))
      return text(key) + " and the one below";
  }
  return {};
}

protocol::Edit disc(double x, double y, double radius, bool fill) {
  return {.stencil = protocol::StencilShape::circle,
          .fill = fill,
          .radius = radius,
          .path = {{x, y}},
          .stroke = {}};
}

protocol::Edit box(double x, double y, double radius, bool fill) {
  protocol::Edit edit = disc(x, y, radius, fill);
  edit.stencil = protocol::StencilShape::square;
  return edit;
}

protocol::LayerChange add_layer(const std::string& name) {
  return {.layer = {}, .name = name, .color = {}, .wall = {}};
}

protocol::LayerChange rename_layer(std::uint32_t layer, const std::string& name) {
  return {.layer = layer, .name = name, .color = {}, .wall = {}};
}

protocol::Edit on_layer(std::uint32_t layer, protocol::Edit edit) {
  edit.layer = layer;
  return edit;
}

protocol::View view_all(std::uint32_t n) { return {.n = n, .rect = {}, .have = {}, .id = {}}; }

protocol::View view_rect(std::uint32_t n, protocol::MapRect rect) {
  return {.n = n, .rect = rect, .have = {}, .id = {}};
}

}  // namespace earthwork::room
