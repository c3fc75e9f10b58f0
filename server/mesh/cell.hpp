/// The contour inside one cell: the square between four voxels.
///
/// Corners a (lower left), b (lower right), c (upper left), d (upper right); a cell's case is
/// a + 2b + 4c + 8d over the filled ones. All coordinates are in 1/32768 of the cell from a.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "server/mesh/feature.hpp"
#include "server/voxel/crossing.hpp"

namespace earthwork::mesh {

/// The cell's sides, by the crossing on them: aX bottom, bY right, cX top, aY left.
enum Side : std::uint8_t { kBottom, kRight, kTop, kLeft };

/// The crossings on the sides; those on sides without one are not looked at.
using CellHits = std::array<voxel::Crossing, 4>;

/// One run of the contour through the cell, from a crossing to another, filled ground on its left.
struct Piece {
  Side from, to;
  std::optional<CellPoint> feature;  ///< Strictly inside the cell.
};

struct CellContour {
  int count = 0;                ///< Of pieces: none in cases 0 and 15, two in cases 6 and 9.
  std::array<Piece, 2> pieces;  ///< Only the first `count` mean something.
  bool connected = false;       ///< The two corners of case 6 or 9 are joined.
  int clamped_features = 0;     ///< Corners' features that lay strictly beyond a far side.
};

/// Where the crossing on `side` lies.
CellPoint place(Side side, voxel::Crossing crossing);

/// A map's sharpness limit in squared normal units, for angles 0 < a <= 175 degrees.
std::int64_t sharpness_limit(double max_feature_angle_degrees);

/// GEOMETRY: "Cells".
CellContour contour(unsigned cell_case, const CellHits& hits, std::int64_t limit);

/// Twice the area of the cell's polygons in squared cell units; where separate corners overlap
/// both count.
std::int64_t twice_cell_area(unsigned cell_case, const CellHits& hits, const CellContour& contour);

}  // namespace earthwork::mesh
