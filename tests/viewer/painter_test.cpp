// One's own strokes: what they are called.
#include "client/viewer/painter.hpp"

#include <gtest/gtest.h>

#include "tests/viewer/played_server.hpp"

namespace earthwork::viewer {
namespace {

TEST(Painter, AStrokeAfterAReloadIsNoMoreOfOneBeforeIt) {
  Notices notices;
  std::vector<std::int64_t> strokes;
  const auto keep = [&](const protocol::Edit& edit) -> protocol::Result<protocol::MessageId> {
    strokes.push_back(edit.stroke.value());
    return protocol::MessageId{7};
  };
  for (const std::int64_t last_number : {0, 1000}) {
    Painter painter(keep, notices, last_number);
    painter.begin({}, {}, {0, 0}, {});
    painter.begin({}, {}, {0, 0}, {});
  }
  EXPECT_EQ(strokes, (std::vector<std::int64_t>{1, 2, 1001, 1002}));
}

TEST(Painter, NumbersStrokesAboveTheLastIdThatAPageHasUsed) {
  ViewerOptions options = PlayedServer::default_options();
  options.last_id = 1'700'000'000'000'000;
  PlayedServer server(options);
  server.join(bounded());
  server.press(400, 300);
  EXPECT_EQ(server.last("edit")["stroke"], 1'700'000'000'000'001);
  EXPECT_EQ(server.last("edit")["id"], 1'700'000'000'000'001);
}

}  // namespace
}  // namespace earthwork::viewer
