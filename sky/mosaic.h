// What do the four pixels of a mosaic cell read?
//
// A division-of-focal-plane sensor has a polarizer on every pixel: 0, 45, 90 and 135 degrees in
// each 2x2 cell, counted row by row from the top left pixel.
//   layout text   "90,45/135,0": first row / second row, in degrees as data sheets print them:
//                 counterclockwise from the rows' direction on the displayed image
//   angles here   from S's x (right) towards its y (down), so the negative of those
// A pixel under light of intensity I, Q/I = q, U/I = u about the axes of its ray reads
//   gain I (1 + q cos 2a + u sin 2a)   [Zeng2020, eq. 2].
// Not in it: leakage of the polarizers (it shortens q and u alike), light that strays to a
// neighbouring pixel.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace polnav::sky {

using Cell = std::array<double, 4>;

// Polarizer angles [rad]. Throws std::invalid_argument when the text is no layout.
[[nodiscard]] Cell ParseLayout(const std::string& text);

// Rows: the pixels of a cell. Columns: their answer to I, Q and U.
[[nodiscard]] Eigen::Matrix<double, 4, 3> AnalyzerMatrix(const Cell& angle_rad, const Cell& gain);

}  // namespace polnav::sky
