#include "protocol/gltf/wall_strip.hpp"

namespace earthwork::protocol {
namespace {

class StripBuilder {
 public:
  void add(const WallSection& section) {
    const WallPost start{section.a, section.normal_a}, end{section.b, section.normal_b};
    const bool goes_on = !strip_.panels.empty() && strip_.posts[last_].vertex == start.vertex;
    std::uint32_t from = last_;
    if (!goes_on || strip_.posts[last_] != start) from = stand(start);
    if (!goes_on) first_ = from;
    last_ = strip_.posts[first_] == end ? first_ : stand(end);
    strip_.panels.push_back({from, last_});
  }
  WallStrip take() { return std::move(strip_); }

 private:
  std::uint32_t stand(const WallPost& post) {
    strip_.posts.push_back(post);
    return static_cast<std::uint32_t>(strip_.posts.size() - 1);
  }

  WallStrip strip_;
  std::uint32_t first_ = 0;  // the post where the contour began
  std::uint32_t last_ = 0;   // the post where the last section ended
};

}  // namespace

WallStrip wall_strip(const ChunkMesh& mesh) {
  StripBuilder builder;
  for (const WallSection& section : mesh.sections) builder.add(section);
  return builder.take();
}

}  // namespace earthwork::protocol
