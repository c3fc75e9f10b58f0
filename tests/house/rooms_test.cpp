// That the room rules find what they are there to find.
#include "tests/house/rooms.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace earthwork::house {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Findings check(std::string path, std::string text) {
  static const std::set<std::string_view> known = {"protocol/edit.hpp",      "server/voxel/map.hpp",
                                                   "server/mesh/mesher.hpp", "server/room/room.hpp",
                                                   "server/net/http.hpp",    "client/link/link.hpp",
                                                   "client/scene/mesh.hpp",  "tests/net/fake.hpp"};
  return check_includes({std::move(path), std::move(text)}, known);
}

TEST(Rooms, LetIncludesPointDown) {
  EXPECT_THAT(check("server/mesh/a.cpp",
                    "#include \"server/voxel/map.hpp\"\n#include \"server/mesh/mesher.hpp\"\n"),
              IsEmpty());
  EXPECT_THAT(check("client/bot/a.cpp", "#include \"client/link/link.hpp\"\n"), IsEmpty());
}

TEST(Rooms, RefuseAnArrowThatPointsUp) {
  EXPECT_THAT(check("server/voxel/a.cpp", "\n#include \"server/mesh/mesher.hpp\"\n"),
              ElementsAre("server/voxel/a.cpp:2: server/mesh/mesher.hpp: "
                          "no arrow from server/voxel to server/mesh"));
  EXPECT_THAT(check("protocol/a.hpp", "#include \"server/voxel/map.hpp\"\n"),
              ElementsAre("protocol/a.hpp:1: server/voxel/map.hpp: "
                          "no arrow from protocol to server/voxel"));
}

TEST(Rooms, RefuseAnArrowBetweenServerAndClient) {
  EXPECT_EQ(check("client/scene/a.cpp", "#include \"server/voxel/map.hpp\"\n").size(), 1u);
  EXPECT_EQ(check("server/net/a.cpp", "#include \"client/link/link.hpp\"\n").size(), 1u);
}

TEST(Rooms, RefuseTestsAndUnknownFiles) {
  EXPECT_THAT(check("server/net/a.cpp", "#include \"tests/net/fake.hpp\"\n"),
              ElementsAre("server/net/a.cpp:1: tests/net/fake.hpp: that file is in no room"));
  EXPECT_THAT(check("server/net/a.cpp", "#include \"http.hpp\"\n"),
              ElementsAre("server/net/a.cpp:1: http.hpp: no such file; "
                          "project includes start at the root"));
}

TEST(Rooms, KnowTheRoomOfEveryFile) {
  EXPECT_THAT(check("server/util/a.cpp", ""),
              ElementsAre("server/util/a.cpp: this folder is no room that the table knows"));
  EXPECT_EQ(room_of("protocol/gltf/glb.cpp")->folder, "protocol/gltf");
  EXPECT_EQ(room_of("server/net/http/a.cpp"), nullptr);
}

TEST(Rooms, KeepTheOutsideOutOfPureOnes) {
  EXPECT_EQ(check("server/mesh/a.cpp", "#include <chrono>\n").size(), 1u);
  EXPECT_EQ(check("server/voxel/a.cpp", "#include  <thread>\n").size(), 1u);
  EXPECT_EQ(check("server/voxel/a.cpp", "#include <spdlog/spdlog.h>\n").size(), 1u);
  EXPECT_THAT(check("server/voxel/a.cpp", "#include <bit>\n#include <xxhash.h>\n"), IsEmpty());
  EXPECT_THAT(check("server/room/a.cpp", "#include <chrono>\n"), IsEmpty());
}

TEST(Rooms, KeepBoostOutOfTheProtocol) {
  EXPECT_EQ(check("protocol/a.cpp", "#include <boost/asio.hpp>\n").size(), 1u);
  EXPECT_EQ(check("client/scene/a.cpp", "#include <boost/url.hpp>\n").size(), 1u);
}

TEST(Rooms, KeepHeavyBodiesOutOfHeaders) {
  EXPECT_THAT(check("protocol/a.hpp", "#include <nlohmann/json.hpp>\n"),
              ElementsAre("protocol/a.hpp:1: nlohmann/json.hpp: too heavy for a header"));
  EXPECT_EQ(check("server/net/a.hpp", "#include <boost/beast/http.hpp>\n").size(), 1u);
  EXPECT_THAT(check("protocol/a.hpp", "#include <nlohmann/json_fwd.hpp>\n"), IsEmpty());
  EXPECT_THAT(check("protocol/a.cpp", "#include <nlohmann/json.hpp>\n"), IsEmpty());
}

TEST(Rooms, LetTestsSeeEverything) {
  EXPECT_THAT(check("tests/voxel/a.cpp", "#include \"server/net/http.hpp\"\n"), IsEmpty());
}

TEST(Rooms, FormNoCircle) {
  // Rooms are listed from the bottom up within their folder, so arrows of a folder point back.
  for (const Room& room : rooms()) {
    for (const std::string_view below : room.arrows) {
      const auto is = [](std::string_view name) {
        return [name](const Room& other) { return other.folder == name; };
      };
      const auto at = std::find_if(rooms().begin(), rooms().end(), is(below));
      EXPECT_LT(at, std::find_if(rooms().begin(), rooms().end(), is(room.folder)))
          << room.folder << " -> " << below;
    }
  }
}

}  // namespace
}  // namespace earthwork::house
