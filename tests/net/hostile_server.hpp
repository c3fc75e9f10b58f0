/// The ground for hostile tests: a server with a map on which somebody who behaves goes on
/// painting, from before the test's first byte to after its last one.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>

#include "server/net/server.hpp"
#include "tests/net/painter.hpp"
#include "tests/net/raw_client.hpp"
#include "tests/room/atlas_calls.hpp"

namespace earthwork::net {

/// Limits of time that a test does not meet unless it sets them itself.
inline SessionLimits patient() {
  SessionLimits limits;
  limits.hello = limits.silence = limits.request = std::chrono::minutes(2);
  limits.farewell = std::chrono::seconds(1);
  return limits;
}

/// The map "m" has chunks of 8 voxels and no bounds.
struct HostileTest : testing::Test {
  explicit HostileTest(const SessionLimits& limits = patient()) {
    server =
        Server::start({.listen = {"127.0.0.1", 0}, .allowed_hosts = {}, .limits = limits}).value();
    port = server->address().port;
    EXPECT_TRUE(room::create_map(server->atlas(), "m", {.chunk_resolution = 8, .chunks = {}}));
    painter = std::make_unique<Painter>(port, "m");
    EXPECT_TRUE(painter->is_answered());
  }
  ~HostileTest() override {
    EXPECT_TRUE(painter->is_answered());
    EXPECT_EQ(http_get(port, "/healthz").body, "ok\n");
  }

  std::unique_ptr<Server> server;
  std::uint16_t port = 0;
  std::unique_ptr<Painter> painter;
};

}  // namespace earthwork::net
