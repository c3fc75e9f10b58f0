// Writes PNG files of any colour type, for tests.
#pragma once

#include <png.h>

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace earthwork::bot {

struct PngFile {
  unsigned width = 1, height = 1;
  int colour_type = PNG_COLOR_TYPE_GRAY, depth = 8;
  bool interlaced = false;
  std::vector<png_color> palette = {};
  double gamma = 0;                             // 0: none is written
  std::vector<std::vector<std::uint8_t>> rows;  // packed as the file has them
};

inline void write_png(const std::string& path, const PngFile& png) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  png_structp writer = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(writer);
  png_init_io(writer, file);
  png_set_IHDR(writer, info, png.width, png.height, png.depth, png.colour_type,
               png.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!png.palette.empty())
    png_set_PLTE(writer, info, png.palette.data(), static_cast<int>(png.palette.size()));
  if (png.gamma > 0) png_set_gAMA(writer, info, png.gamma);
  std::vector<png_bytep> rows;
  auto copy = png.rows;
  for (auto& row : copy) rows.push_back(row.data());
  png_set_rows(writer, info, rows.data());
  png_write_png(writer, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&writer, &info);
  std::fclose(file);
}

}  // namespace earthwork::bot
