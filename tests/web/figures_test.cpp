#include "client/viewer/web/figures.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace earthwork::viewer {
namespace {

using nlohmann::json;

json written(const Figures& figures) { return json::parse(figures.write(1000)); }

TEST(Figures, SayNothingOfPicturesThatNeverWere) {
  EXPECT_EQ(written(Figures()),
            json::parse(R"({"frames":0,"input_to_picture_ms":[],"draw_ms":[],"triangles":0,
                            "draws":0,"heap_bytes":1000})"));
}

TEST(Figures, TheFirstPictureHasATriangle) {
  Figures figures;
  figures.draw({.began_ms = 100, .ended_ms = 102});
  figures.draw({.began_ms = 200, .ended_ms = 205, .triangles = 7, .draws = 2});
  figures.draw({.began_ms = 300, .ended_ms = 301, .whole = true, .triangles = 9, .draws = 3});
  figures.draw({.began_ms = 400, .ended_ms = 401, .whole = true, .triangles = 8, .draws = 1});
  const json out = written(figures);
  EXPECT_EQ(out["frames"], 4);
  EXPECT_EQ(out["first_picture_ms"], 205);
  EXPECT_EQ(out["whole_picture_ms"], 301);
  EXPECT_EQ(out["draw_ms"], json({2, 5, 1, 1}));
  EXPECT_EQ(out["triangles"], 8);
  EXPECT_EQ(out["draws"], 1);
}

TEST(Figures, AnInputLastsUntilMeshesAreNew) {
  Figures figures;
  figures.draw({.began_ms = 10, .ended_ms = 11, .meshes_changed = true});
  figures.press(100);
  figures.draw({.began_ms = 110, .ended_ms = 111});
  figures.press(120);
  figures.draw({.began_ms = 130, .ended_ms = 135, .meshes_changed = true});
  figures.draw({.began_ms = 140, .ended_ms = 145, .meshes_changed = true});
  figures.press(200);
  figures.draw({.began_ms = 210, .ended_ms = 212, .meshes_changed = true});
  EXPECT_EQ(written(figures)["input_to_picture_ms"], json({35, 12}));
}

TEST(Figures, RememberTheLastOnes) {
  Figures figures;
  for (int i = 0; i <= static_cast<int>(Figures::kKept); ++i)
    figures.draw({.began_ms = 0, .ended_ms = static_cast<double>(i)});
  const json kept = written(figures)["draw_ms"];
  EXPECT_EQ(kept.size(), Figures::kKept);
  EXPECT_EQ(kept.front(), 1);
  EXPECT_EQ(kept.back(), Figures::kKept);
}

}  // namespace
}  // namespace earthwork::viewer
