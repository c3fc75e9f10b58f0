// A guarded viewer: what it throws stops there.
#include "server/room/guarded_viewer.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

namespace earthwork::room {
namespace {

/// Writes down what it is called for, and throws at one of these calls.
struct Fragile final : Viewer {
  explicit Fragile(std::string at) : throws_at(std::move(at)) {}
  void answered(std::vector<Reply>) override { called("answered"); }
  void deliver(Parcel) override { called("deliver"); }
  void tell(Talk) override { called("tell"); }
  void settings(SharedText) override { called("settings"); }
  void end(protocol::Bye bye) override {
    code = bye.failure.code;
    called("end");
  }
  void called(const std::string& name) {
    calls += name + ' ';
    if (name == throws_at || throws_at == "always") throw std::runtime_error(name);
  }
  std::string throws_at, calls;
  std::optional<protocol::Code> code;
};

struct GuardedViewerTest : testing::Test {
  void use(const std::string& throws_at) {
    inner = std::make_shared<Fragile>(throws_at);
    GuardedViewer viewer(inner, [this] { ++broke; });
    viewer.answered({});
    viewer.deliver({});
    viewer.tell({});
    viewer.settings({});
    viewer.guard([this] { inner->called("guard"); });
    broken = viewer.broken();
  }
  std::shared_ptr<Fragile> inner;
  int broke = 0;
  bool broken = false;
};

TEST_F(GuardedViewerTest, HandsOnWhatItIsTold) {
  use("");
  EXPECT_EQ(inner->calls, "answered deliver tell settings guard ");
  EXPECT_FALSE(broken);
  EXPECT_EQ(broke, 0);
}

TEST_F(GuardedViewerTest, EndsAViewerThatThrowsAndCallsItNoMore) {
  use("answered");
  EXPECT_EQ(inner->calls, "answered end ");
  EXPECT_EQ(inner->code, protocol::Code::internal);
  EXPECT_TRUE(broken);
  EXPECT_EQ(broke, 1);
  use("deliver");
  EXPECT_EQ(inner->calls, "answered deliver end ");
  use("tell");
  EXPECT_EQ(inner->calls, "answered deliver tell end ");
  use("settings");
  EXPECT_EQ(inner->calls, "answered deliver tell settings end ");
  use("guard");
  EXPECT_EQ(inner->calls, "answered deliver tell settings guard end ");
  EXPECT_EQ(broke, 5);
}

TEST_F(GuardedViewerTest, BearsOneThatThrowsAtItsEndToo) {
  use("always");
  EXPECT_EQ(inner->calls, "answered end ");
  EXPECT_TRUE(broken);
  EXPECT_EQ(broke, 1);
}

}  // namespace
}  // namespace earthwork::room
