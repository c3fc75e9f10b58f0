// Exports: their tags, and the file made from records.
#include "server/net/glb_export.hpp"

#include <gtest/gtest.h>

#include "protocol/chunk_record.hpp"

namespace earthwork::net {
namespace {

TEST(GlbExport, ATagFollowsMeshAndSettings) {
  protocol::MapSettings settings;
  const std::string tag = export_tag(settings, 0x12);
  EXPECT_EQ(tag, export_tag(settings, 0x12));
  EXPECT_NE(tag, export_tag(settings, 0x13));
  settings.layers[0].color = "#000000";
  EXPECT_NE(tag, export_tag(settings, 0x12));
  EXPECT_EQ(tag.substr(0, 18), "\"0000000000000012-");
  EXPECT_EQ(tag.back(), '"');
}

TEST(GlbExport, IsMadeFromRecords) {
  protocol::ChunkRecord record;
  record.key = {0, 3, -2, 0};
  record.mesh.vertices = {{20000, 20000}, {60000, 20000}, {20000, 60000}};
  record.mesh.triangles = {0, 1, 2};
  auto bytes = std::make_shared<std::string>();
  protocol::encode_record(record, *bytes);
  const std::vector<room::RecordBytes> records{bytes};
  const auto file = make_glb({}, records);
  ASSERT_TRUE(file);
  EXPECT_TRUE(file->starts_with("glTF"));
  EXPECT_NE(file->find("chunk_3_-2"), std::string::npos);
}

TEST(GlbExport, ABrokenRecordIsAFailure) {
  const std::vector<room::RecordBytes> records{std::make_shared<std::string>("nonsense")};
  const auto file = make_glb({}, records);
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, protocol::Code::bad_frame);
}

}  // namespace
}  // namespace earthwork::net
