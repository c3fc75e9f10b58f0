/// The names that a map's figures have to have.
#pragma once

namespace earthwork::net {

inline constexpr const char* kFigureNames[] = {"surface_area",
                                               "wall_length",
                                               "wall_sections",
                                               "degenerate_wall_sections",
                                               "sharp_features",
                                               "clamped_features",
                                               "cells_by_case",
                                               "diagonal_connections",
                                               "filled_voxels",
                                               "edits",
                                               "borderline_cells",
                                               "mesh_hash",
                                               "hash",
                                               "seq",
                                               "triangles",
                                               "vertices",
                                               "chunks",
                                               "voxel_bytes",
                                               "mesh_bytes",
                                               "bytes_per_voxel"};

}  // namespace earthwork::net
