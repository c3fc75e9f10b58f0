// What the tests draw on: a context without a window, a renderer and a map.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "client/viewer/render/offscreen.hpp"
#include "client/viewer/render/renderer.hpp"
#include "tests/render/drawn_map.hpp"
#include "tests/render/golden_picture.hpp"

namespace earthwork::viewer {

constexpr int kWidth = 320, kHeight = 200;

class Stage : public testing::Test {
 protected:
  void SetUp() override {
    auto offscreen = render::Offscreen::make(kWidth, kHeight);
    ASSERT_TRUE(offscreen) << offscreen.error().detail;
    offscreen_ = std::move(*offscreen);
    auto renderer = Renderer::make();
    ASSERT_TRUE(renderer) << renderer.error().detail;
    renderer_ = std::move(*renderer);
  }

  Pixels draw(DrawnMap& map, const Picture& picture) {
    map.show(*renderer_);
    offscreen_->bind();
    counts_ = renderer_->draw(picture);
    return {kWidth, kHeight, offscreen_->read()};
  }
  Pixels draw(DrawnMap& map, const scene::Camera::Place& place) {
    return draw(map, look_at(map.settings, place, kWidth, kHeight));
  }

  std::unique_ptr<render::Offscreen> offscreen_;
  std::unique_ptr<Renderer> renderer_;  // goes before its context
  DrawCounts counts_;
};

}  // namespace earthwork::viewer
